#include "volume/field/depth_overshoot.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pith {

std::vector<DepthPlace> guards_of(const DepthGraph& graph, const PerVertex<float>& interpolated,
                                  const PerVertex<std::uint8_t>& held, std::span<const DepthPlace> place,
                                  double persistence, std::size_t most) {
  const auto overshoot = [&](VertexId v) { return std::max(double(interpolated[v]) - 1, -double(interpolated[v])); };
  std::vector<VertexId> worst;
  for (const VertexId v : graph.vertex)
    if (!held[v] && overshoot(v) >= persistence) worst.push_back(v);
  std::sort(worst.begin(), worst.end(), [&](VertexId a, VertexId b) {
    return std::pair(-overshoot(a), a.value) < std::pair(-overshoot(b), b.value);
  });
  double least = 1, largest = 0;
  for (const DepthPlace& p : place) least = std::min(least, p.value), largest = std::max(largest, p.value);

  std::vector<DepthPlace> guards;
  for (const VertexId v : worst) {
    if (guards.size() >= most) break;
    const Vec3d& x = graph.mesh.position[v];
    const double bound = interpolated[v] > 0.5f ? largest : least;
    double to_bound = std::numeric_limits<double>::infinity(), to_other = to_bound, other = bound;
    for (const DepthPlace& p : place) {
      const double distance = (p.point - x).norm();
      if (p.value == bound)
        to_bound = std::min(to_bound, distance);
      else if (distance < to_other)
        to_other = distance, other = p.value;
    }
    if (!(to_bound > 0) || !std::isfinite(to_other)) continue;
    const bool apart = std::all_of(guards.begin(), guards.end(),
                                   [&](const DepthPlace& g) { return (g.point - x).norm() > 0.5 * to_bound; });
    if (apart) guards.push_back({x, bound + 0.5 * (other - bound) * to_bound / (to_bound + to_other)});
  }
  return guards;
}

} // namespace pith
