// Sampling of strokes.
#include "volume/field/polyline.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>

namespace pith {

double length_of(std::span<const Vec3d> polyline) {
  double length = 0;
  for (std::size_t i = 1; i < polyline.size(); ++i) length += (polyline[i] - polyline[i - 1]).norm();
  return length;
}

std::vector<PolylineSample> evenly_sampled(std::span<const Vec3d> polyline, double spacing) {
  std::vector<PolylineSample> samples;
  if (polyline.empty()) return samples;
  const double total = length_of(polyline);
  if (!std::isfinite(total))
    throw InvalidInput("stroke", "its length is beyond what can be measured", "give points near the model, in mm");
  if (!(total > 0)) return {{polyline.front(), Vec3d::Zero()}};
  constexpr double most = 1e5;
  const auto steps = static_cast<std::size_t>(std::clamp(std::ceil(total / spacing * (1 - 1e-12)), 1.0, most));
  std::size_t segment = 1;
  double before = 0, length = (polyline[1] - polyline[0]).norm();
  for (std::size_t i = 0; i <= steps; ++i) {
    const double at = total * static_cast<double>(i) / static_cast<double>(steps);
    while (segment + 1 < polyline.size() && (before + length < at || length == 0)) {
      before += length;
      ++segment;
      length = (polyline[segment] - polyline[segment - 1]).norm();
    }
    const Vec3d &a = polyline[segment - 1], &b = polyline[segment];
    if (length > 0) samples.push_back({a + std::clamp((at - before) / length, 0.0, 1.0) * (b - a), (b - a) / length});
  }
  if (!samples.empty()) samples.back().point = polyline.back();
  return samples;
}

double squared_distance(const Vec3d& x, const Vec3d& a, const Vec3d& b) {
  const Vec3d along = b - a;
  const double length = along.squaredNorm();
  const double t = length > 0 ? std::clamp((x - a).dot(along) / length, 0.0, 1.0) : 0.0;
  return (x - (a + t * along)).squaredNorm();
}

std::vector<std::uint8_t> near_region(const TetMesh& mesh, std::int32_t region, std::span<const Vec3d> points,
                                      double margin) {
  Box all;
  for (const Vec3d& p : points) all.add(p);
  all.low.array() -= margin;
  all.high.array() += margin;
  std::vector<std::atomic<std::uint8_t>> near(points.size()); // only ever raised: the order does not matter
  parallel_for(mesh.tet_count(), 4096, [&](std::size_t t) {
    if (region >= 0 && mesh.region[TetId(t)] != region) return;
    Box box;
    for (const VertexId v : mesh.corner[TetId(t)]) box.add(mesh.position[v]);
    if ((box.high.array() < all.low.array()).any() || (box.low.array() > all.high.array()).any()) return;
    box.low.array() -= margin;
    box.high.array() += margin;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (near[i].load(std::memory_order_relaxed) || !box.contains(points[i])) continue;
      bool outside = false;
      for (const auto& corner : facet_corners) {
        const Vec3d& a = mesh.position[mesh.corner[TetId(t)][corner[0]]];
        const Vec3d& b = mesh.position[mesh.corner[TetId(t)][corner[1]]];
        const Vec3d& c = mesh.position[mesh.corner[TetId(t)][corner[2]]];
        const Vec3d normal = (b - a).cross(c - a);
        outside = outside || normal.dot(points[i] - a) > margin * normal.norm();
      }
      if (!outside) near[i].store(1, std::memory_order_relaxed);
    }
  });
  return {near.begin(), near.end()};
}

} // namespace pith
