#include "volume/cut/clusters.h"

#include "volume/base/morton.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace pith {
namespace {

constexpr std::size_t tets_per_cluster = 128;

} // namespace

TetClusters clusters_of(const TetMesh& root) {
  TetClusters result;
  const std::size_t count = root.tet_count();
  const Box box = bounds_of(root);
  const double cells = 1023 / std::max(box.extent().maxCoeff(), 1e-300);
  std::vector<std::pair<std::uint64_t, TetId>> order(count);
  parallel_for(count, 16384, [&](std::size_t t) {
    const Vec3d at = cells * (barycenter(root, TetId(t)) - box.low);
    const auto cell = [&](int axis) { return static_cast<std::int32_t>(std::clamp(at[axis], 0.0, 1023.0)); };
    order[t] = {morton_code({cell(0), cell(1), cell(2)}), TetId(t)};
  });
  std::sort(order.begin(), order.end());

  PerVertex<double> reach(root.vertex_count(), 0.0); // the longest edge at each vertex
  for (const auto& corner : root.corner)
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) {
        const double length = (root.position[corner[i]] - root.position[corner[j]]).norm();
        reach[corner[i]] = std::max(reach[corner[i]], length);
        reach[corner[j]] = std::max(reach[corner[j]], length);
      }

  result.around = tets_around_vertices(root);
  result.cluster.resize(count);
  result.ball.resize((count + tets_per_cluster - 1) / tets_per_cluster);
  parallel_for(result.ball.size(), 64, [&](std::size_t c) {
    const std::size_t begin = c * tets_per_cluster, end = std::min(count, begin + tets_per_cluster);
    Box around;
    for (std::size_t i = begin; i < end; ++i) {
      result.cluster[order[i].second] = static_cast<std::uint32_t>(c);
      for (const VertexId v : root.corner[order[i].second]) around.add(root.position[v]);
    }
    TetClusters::Ball& ball = result.ball[c];
    ball = {around.center(), 0};
    for (std::size_t i = begin; i < end; ++i)
      for (const VertexId v : root.corner[order[i].second])
        ball.radius = std::max(ball.radius, (root.position[v] - ball.center).norm() + reach[v]);
    ball.radius *= 1 + 1e-9;
  });
  return result;
}

std::vector<std::int8_t> sides_of_clusters(const TetClusters& clusters, const LevelSet& level_set,
                                           const Rigid& placement) {
  std::vector<std::int8_t> side(clusters.count());
  parallel_for(clusters.count(), 256, [&](std::size_t c) {
    const TetClusters::Ball& ball = clusters.ball[c];
    side[c] = static_cast<std::int8_t>(level_set.side_of_ball(placement(ball.center), ball.radius));
  });
  return side;
}

} // namespace pith
