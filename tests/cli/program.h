#pragma once
// Runs the real program, and what it left behind.
#include "tests/support/scratch.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace pith::testing {

struct Outcome {
  int code = -1; ///< exit code; −1 when a signal ended it
  std::string output, complaint;
  std::size_t complaint_lines() const {
    return static_cast<std::size_t>(std::count(complaint.begin(), complaint.end(), '\n'));
  }
};

/// A scratch folder with the program's cache inside; commands run in it.
class Program {
public:
  /// A running program.
  struct Process {
    pid_t id;
  };

  Process start(const std::vector<std::string>& arguments) const {
    const pid_t id = ::fork();
    if (id != 0) return {id};
    // In the child: only calls that may follow a fork.
    if (::chdir(folder.path().c_str()) != 0) ::_exit(99);
    ::setenv("XDG_CACHE_HOME", (folder / ".cache").c_str(), 1);
    if (!::freopen((folder / ".output").c_str(), "w", stdout) ||
        !::freopen((folder / ".complaint").c_str(), "w", stderr))
      ::_exit(99);
    if (most_file_bytes > 0) {
      const rlimit limit{most_file_bytes, most_file_bytes};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    std::vector<std::string> command{PITH_BINARY_DIR "/pith"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : command) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    ::execv(pointers[0], pointers.data());
    ::_exit(98);
  }

  Outcome finish(Process process) const {
    int status = 0;
    ::waitpid(process.id, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(folder / ".output"),
            content_of(folder / ".complaint")};
  }

  Outcome run(const std::vector<std::string>& arguments) const { return finish(start(arguments)); }

  /// Names of the files in the folder, but those of this class.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      const std::string name = entry.path().filename().string();
      if (name != ".cache" && name != ".output" && name != ".complaint") names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  ScratchFolder folder;
  rlim_t most_file_bytes =
      0; ///< how large files may grow that the program writes: a stand-in for a full disk; 0: any
};

} // namespace pith::testing
