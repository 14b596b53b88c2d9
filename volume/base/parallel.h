#pragma once
// Parallel loops whose results do not depend on the number of threads: work is split into blocks of a size that the
// caller fixes, and reductions run over a fixed tree.
#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <vector>

namespace pith {

/// Calls body(begin, end) for consecutive blocks of `block` elements of [0, count), on all threads allowed.
/// The body must write only to what its block owns. Exceptions are passed on.
void parallel_blocks(std::size_t count, std::size_t block, const std::function<void(std::size_t, std::size_t)>& body);

/// Calls body(i) for every i in [0, count).
template <class Body>
void parallel_for(std::size_t count, std::size_t block, const Body& body) {
  parallel_blocks(count, block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// Sum of term(i) over [0, count): blocks are summed in order inside, then pairwise, so that the rounding is always
/// the same.
double ordered_sum(std::size_t count, const std::function<double(std::size_t)>& term);

/// Limits the threads of everything that runs while this object lives; 0 means all cores.
class ThreadLimit {
public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
  void* control_;
};

/// How far work has come. The callback may be called from any thread, one call at a time per stage; returning false
/// asks for the work to stop, and the function that took it throws Cancelled soon after.
using Progress = std::function<bool(double fraction)>;

/// Calls `progress` if there is one and throws Cancelled when it says stop.
void report(const Progress& progress, double fraction);

/// Progress of work that several threads share: for calls from inside a parallel loop. `progress` must outlive it.
class SharedProgress {
public:
  SharedProgress(const Progress& progress, std::size_t total) : progress_(progress), total_(total) {}

  /// Adds to what is done and reports, unless another thread is just doing so. Throws Cancelled.
  void add(std::size_t done = 1);

private:
  const Progress& progress_;
  std::size_t total_;
  std::atomic<std::size_t> done_{0};
  std::mutex reporting_;
};

} // namespace pith
