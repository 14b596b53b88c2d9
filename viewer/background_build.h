#pragma once
// Recipes built beside the window: one at a time, the newest wins.
#include "recipe/build.h"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

namespace pith {

class BackgroundBuild {
public:
  explicit BackgroundBuild(BuildOptions options);
  ~BackgroundBuild(); ///< cancels and waits

  /// Starts; what is being built is given up. `ticket` comes back with the result.
  void start(std::uint64_t ticket, Recipe recipe, std::filesystem::path folder);
  void cancel(); ///< the build ends with no result soon after
  bool busy() const;

  struct Status {
    std::string stage;
    double fraction = 0;
  };
  Status status() const;

  /// What has ended since the last call, if anything. `error` is empty when it went well.
  struct Outcome {
    std::uint64_t ticket = 0;
    std::optional<BuildResult> result;
    std::string error;
    bool cancelled = false;
  };
  std::optional<Outcome> take();
  /// Blocks until nothing is being built.
  void wait() const;

private:
  struct Job {
    std::uint64_t ticket;
    Recipe recipe;
    std::filesystem::path folder;
  };
  void work();

  Builder builder_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::optional<Job> next_;
  std::optional<Outcome> done_;
  Status status_;
  bool running_ = false, cancel_ = false, stop_ = false;
  std::thread thread_; ///< last: starts when all else is there
};

} // namespace pith
