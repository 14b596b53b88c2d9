// Edges, shells and nesting of a triangle surface.
#include "volume/mesh/tetrahedralize_shells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace pith::surface {

std::vector<EdgeSide> edge_sides(const TriMesh& mesh) {
  // A counting sort by the lower vertex; inside a bucket (half a dozen sides) by the rest.
  const auto for_each_side = [&](const auto& body) {
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
      const auto& corner = mesh.corner[TriangleId(t)];
      if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t from = corner[k], to = corner[k == 2 ? 0 : k + 1];
        body(EdgeSide{std::min(from, to), std::max(from, to), 3 * t + k, from < to});
      }
    }
  };
  std::vector<std::uint32_t> next(mesh.vertex_count() + 1, 0);
  for_each_side([&](const EdgeSide& side) { ++next[side.low + 1]; });
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<EdgeSide> sides(next.back());
  const std::vector<std::uint32_t> begin = next;
  for_each_side([&](const EdgeSide& side) { sides[next[side.low]++] = side; });
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    std::sort(sides.begin() + begin[v], sides.begin() + begin[v + 1], [](const EdgeSide& a, const EdgeSide& b) {
      return a.high != b.high ? a.high < b.high : a.corner < b.corner;
    });
  return sides;
}

PerVertex<char> torn_vertices(const TriMesh& mesh, const std::vector<EdgeSide>& sides) {
  DisjointSets fans(3 * mesh.triangle_count()); // of corners, joined through the edges at their vertex
  const auto corner_at = [](const EdgeSide& side, bool low) {
    const std::uint32_t from = side.corner, to = side.corner % 3 == 2 ? side.corner - 2 : side.corner + 1;
    return side.forward == low ? from : to;
  };
  for_each_edge(sides, [&](const EdgeSide* first, const EdgeSide* last) {
    for (const EdgeSide* side = first + 1; side < last; ++side)
      for (const bool low : {true, false}) fans.join(corner_at(*first, low), corner_at(*side, low));
  });
  PerVertex<std::uint32_t> fan(mesh.vertex_count(), ~0u);
  PerVertex<char> torn(mesh.vertex_count(), 0);
  for (const EdgeSide& side : sides) { // every corner of a proper triangle starts one side
    const VertexId v = mesh.corner[TriangleId(side.corner / 3)][side.corner % 3];
    const std::uint32_t found = fans.representative(side.corner);
    if (fan[v] == ~0u) fan[v] = found;
    if (fan[v] != found) torn[v] = 1;
  }
  return torn;
}

double winding_number(const TriMesh& mesh, const Shell& shell, const Vec3d& point) {
  double angle = 0;
  for (const TriangleId t : shell.triangle) {
    const Vec3d a = mesh.position[mesh.corner[t][0]] - point, b = mesh.position[mesh.corner[t][1]] - point,
                c = mesh.position[mesh.corner[t][2]] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * std::numbers::pi);
}

std::vector<Shell> shells_of(const TriMesh& mesh, const std::vector<EdgeSide>& sides) {
  DisjointSets sets(mesh.triangle_count());
  for_each_edge(sides, [&](const EdgeSide* first, const EdgeSide* last) {
    for (const EdgeSide* side = first + 1; side < last; ++side) sets.join(first->corner / 3, side->corner / 3);
  });
  std::vector<Shell> shells;
  std::vector<std::uint32_t> number(mesh.triangle_count(), 0);
  const Vec3d origin = mesh.position.empty() ? Vec3d::Zero() : mesh.position[VertexId(0u)];
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::uint32_t first = sets.representative(t);
    if (first == t) {
      number[t] = static_cast<std::uint32_t>(shells.size());
      shells.emplace_back();
    }
    Shell& shell = shells[number[t] = number[first]];
    const auto& corner = mesh.corner[TriangleId(t)];
    shell.triangle.push_back(TriangleId(t));
    for (const VertexId v : corner) shell.box.add(mesh.position[v]);
    shell.volume += (mesh.position[corner[0]] - origin)
                        .cross(mesh.position[corner[1]] - origin)
                        .dot(mesh.position[corner[2]] - origin) /
                    6;
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) shell.closed = false;
  }
  for_each_edge(sides, [&](const EdgeSide* first, const EdgeSide* last) {
    if (last - first != 2 || first[0].forward == first[1].forward) shells[number[first->corner / 3]].closed = false;
  });

  // Nesting: one corner of a shell against every closed shell whose box holds it. Among the shells around it the
  // parent is the one that lies in the most of the others.
  std::vector<std::vector<std::uint32_t>> around(shells.size());
  for (std::uint32_t inner = 0; inner < shells.size(); ++inner) {
    const Vec3d& point = mesh.position[mesh.corner[shells[inner].triangle[0]][0]];
    for (std::uint32_t outer = 0; outer < shells.size(); ++outer)
      if (outer != inner && shells[outer].closed && shells[outer].box.contains(point) &&
          std::abs(winding_number(mesh, shells[outer], point)) > 0.5)
        around[inner].push_back(outer);
    shells[inner].depth = static_cast<std::uint32_t>(around[inner].size());
  }
  for (std::uint32_t inner = 0; inner < shells.size(); ++inner)
    for (const std::uint32_t outer : around[inner])
      if (auto& parent = shells[inner].parent; !parent || shells[outer].depth > shells[*parent].depth) parent = outer;
  return shells;
}

} // namespace pith::surface
