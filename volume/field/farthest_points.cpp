// Farthest point sampling: Gonzalez: Clustering to minimize the maximum intercluster distance, 1985.
#include "volume/field/farthest_points.h"

#include "volume/base/parallel.h"

#include <algorithm>

namespace pith {
namespace {

constexpr std::size_t block = 2048;
using Row = Eigen::Array<double, 8, 1>;

} // namespace

std::vector<std::uint32_t> farthest_points(std::span<const Vec3d> points, std::size_t count, std::size_t given) {
  std::vector<std::uint32_t> chosen;
  if (points.empty() || count == 0) return chosen;
  const std::size_t n = points.size(), padded = (n + 7) / 8 * 8, blocks = (n + block - 1) / block;
  std::vector<double> x(padded), y(padded), z(padded), nearest(padded, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = points[i].x();
    y[i] = points[i].y();
    z[i] = points[i].z();
    nearest[i] = std::numeric_limits<double>::infinity();
  }
  std::vector<double> block_largest(blocks);

  const auto choose = [&](std::uint32_t index) {
    chosen.push_back(index);
    const Vec3d p = points[index];
    parallel_blocks(n, block, [&](std::size_t begin, std::size_t end) {
      Row largest = Row::Zero();
      for (std::size_t i = begin; i < std::min((end + 7) / 8 * 8, padded); i += 8) {
        const Row dx = Eigen::Map<const Row>(&x[i]) - p.x(), dy = Eigen::Map<const Row>(&y[i]) - p.y(),
                  dz = Eigen::Map<const Row>(&z[i]) - p.z();
        Eigen::Map<Row> now(&nearest[i]);
        now = now.min(dx * dx + dy * dy + dz * dz);
        largest = largest.max(now);
      }
      block_largest[begin / block] = largest.maxCoeff();
    });
  };

  const std::size_t start = std::min(std::max<std::size_t>(given, 1), std::min(count, n));
  for (std::size_t i = 0; i < start; ++i) choose(static_cast<std::uint32_t>(i));
  while (chosen.size() < std::min(count, n)) {
    const std::size_t best = std::max_element(block_largest.begin(), block_largest.end()) - block_largest.begin();
    if (!(block_largest[best] > 0)) break;
    std::size_t index = best * block;
    while (nearest[index] != block_largest[best]) ++index;
    choose(static_cast<std::uint32_t>(index));
  }
  return chosen;
}

} // namespace pith
