// Measures of triangle surfaces, and welding.
#include "volume/mesh/tri_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <numeric>

namespace pith {

Box bounds_of(const TriMesh& mesh) {
  Box box;
  for (const Vec3d& p : mesh.position) box.add(p);
  return box;
}

double signed_volume(const TriMesh& mesh) {
  if (mesh.position.empty()) return 0;
  // About a vertex of the mesh: a surface far from the origin loses no digits.
  const Vec3d origin = mesh.position[VertexId(0u)];
  double sum = 0;
  for (const auto& corner : mesh.corner) {
    const Vec3d a = mesh.position[corner[0]] - origin, b = mesh.position[corner[1]] - origin,
                c = mesh.position[corner[2]] - origin;
    sum += a.cross(b).dot(c);
  }
  return sum / 6;
}

TriMesh welded(const TriMesh& mesh) {
  const std::size_t count = mesh.vertex_count();
  // Equal positions become neighbours in the sorted order; the lowest number of each group stands for it. Adding 0
  // turns −0 into +0, and ordering by bits gives NaN a place too.
  const auto key = [&](VertexId v) {
    const Vec3d& p = mesh.position[v];
    return std::array<std::uint64_t, 3>{std::bit_cast<std::uint64_t>(p.x() + 0.0),
                                        std::bit_cast<std::uint64_t>(p.y() + 0.0),
                                        std::bit_cast<std::uint64_t>(p.z() + 0.0)};
  };
  std::vector<VertexId> order(count);
  for (std::size_t v = 0; v < count; ++v) order[v] = VertexId(v);
  std::sort(order.begin(), order.end(), [&](VertexId a, VertexId b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  PerVertex<VertexId> stands_for(count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
    stands_for[order[i]] = same ? stands_for[order[i - 1]] : order[i];
  }

  TriMesh result;
  const bool parts = mesh.part.size() == mesh.triangle_count();
  PerVertex<VertexId> number(count);
  for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count())) {
    std::array<VertexId, 3> corner;
    for (int i = 0; i < 3; ++i) corner[i] = stands_for[mesh.corner[t][i]];
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    for (const VertexId v : corner) number[v] = VertexId(0u);
    result.corner.push_back(corner);
    if (parts) result.part.push_back(mesh.part[t]);
  }
  for (const VertexId v : all_ids<VertexId>(count)) {
    if (!number[v].exists()) continue;
    number[v] = VertexId(result.position.size());
    result.position.push_back(mesh.position[v]);
  }
  for (auto& corner : result.corner)
    for (VertexId& v : corner) v = number[v];
  return result;
}

} // namespace pith
