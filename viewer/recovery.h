#pragma once
// Work that a crash would lose, kept beside: each open document has a file that holds its recipe as of the last edit.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace pith {

/// What a recovery file holds.
struct Recovered {
  std::filesystem::path path;   ///< of the recovery file
  std::filesystem::path file;   ///< the document's own file; empty: it had none
  std::filesystem::path folder; ///< what the recipe's paths are relative to
  std::string recipe;           ///< JSON text
};

/// The recovery file of one open document. It is locked for as long as this lives or the process does; so a file
/// without a lock was left behind by a process that was killed.
class RecoveryFile {
public:
  /// Nothing is written before the first keep(). A folder that cannot be written: keep() does nothing.
  explicit RecoveryFile(std::filesystem::path folder);
  ~RecoveryFile(); ///< removes it: the document was closed in order
  RecoveryFile(const RecoveryFile&) = delete;
  RecoveryFile& operator=(const RecoveryFile&) = delete;

  void keep(const std::filesystem::path& file, const std::filesystem::path& folder, const std::string& recipe);
  void forget(); ///< the document is saved

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// What earlier processes left behind, the newest first. Files that are damaged are passed over.
std::vector<Recovered> recoverable(const std::filesystem::path& folder);

} // namespace pith
