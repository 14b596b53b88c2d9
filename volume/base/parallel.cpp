#include "volume/base/parallel.h"

#include "volume/base/error.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>

namespace pith {

void parallel_blocks(std::size_t count, std::size_t block, const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  const std::size_t blocks = (count + block - 1) / block;
  if (blocks == 1) return body(0, count);
  tbb::parallel_for(
      std::size_t(0), blocks, [&](std::size_t b) { body(b * block, std::min(count, (b + 1) * block)); },
      tbb::simple_partitioner());
}

double ordered_sum(std::size_t count, const std::function<double(std::size_t)>& term) {
  constexpr std::size_t block = 1024;
  if (count == 0) return 0;
  std::vector<double> partial((count + block - 1) / block, 0.0);
  parallel_blocks(count, block, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += term(i);
    partial[begin / block] = sum;
  });
  for (std::size_t stride = 1; stride < partial.size(); stride *= 2)
    for (std::size_t i = 0; i + stride < partial.size(); i += 2 * stride) partial[i] += partial[i + stride];
  return partial[0];
}

ThreadLimit::ThreadLimit(int threads)
    : control_(threads > 0 ? new tbb::global_control(tbb::global_control::max_allowed_parallelism, threads) : nullptr) {}

ThreadLimit::~ThreadLimit() { delete static_cast<tbb::global_control*>(control_); }

void report(const Progress& progress, double fraction) {
  if (progress && !progress(fraction)) throw Cancelled();
}

void SharedProgress::add(std::size_t done) {
  const std::size_t so_far = done_ += done;
  if (const std::unique_lock lock(reporting_, std::try_to_lock); lock)
    report(progress_, static_cast<double>(so_far) / static_cast<double>(total_));
}

} // namespace pith
