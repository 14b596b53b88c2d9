#pragma once
// A file that appears whole or not at all: it is written beside its place and renamed at the end.
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace pith {

/// Writes to a hidden file in the folder of `path`. `commit` renames it into place, replacing what was there; without
/// it (an exception, say) the destructor removes it. Where `path` is a symbolic link, what it points to is replaced.
/// Errors, all IoFailure with the path: no such folder, no permission, disk full, `path` is a folder or a device.
/// A file that is committed survives the end of the process; it is not forced to the disk against a loss of power.
class AtomicFile {
public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, std::size_t bytes);
  void write(std::string_view bytes) { write(bytes.data(), bytes.size()); }

  /// Gives the file a hidden name beside the final one, with the same extension: for libraries that write a path by
  /// themselves.
  const std::filesystem::path& beside();
  /// Call once, when everything has been written.
  void commit();

private:
  template <class Make>
  void make_beside(const Make& make);

  std::filesystem::path path_, beside_; // beside_ is empty while the file has no name
  int descriptor_ = -1;
};

/// What the system says about an error number, and how to mend it: "No space left on device; free some space, or
/// write to another disk".
std::string reason_and_mend(int error_number);

/// The whole content at once.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// The whole file; IoFailure when it cannot be read.
std::string file_content(const std::filesystem::path& path);

} // namespace pith
