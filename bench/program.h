#pragma once
// Other programs, run and waited for.
#include <filesystem>
#include <string>
#include <vector>

namespace pith::bench {

struct ProgramResult {
  int code = -1;      ///< exit code; −1 when it was ended by a signal
  std::string output; ///< of standard output, as far as it was asked for
};

/// Runs a program (found on PATH unless it is a path). Standard error is thrown away; standard output is returned
/// when `capture`. `environment` adds NAME=VALUE entries. Throws std::runtime_error when it cannot be started.
ProgramResult run_program(const std::vector<std::string>& command, bool capture = false,
                          const std::vector<std::string>& environment = {});

/// A folder of its own, removed with this object.
class ScratchFolder {
public:
  explicit ScratchFolder(const std::filesystem::path& parent);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

} // namespace pith::bench
