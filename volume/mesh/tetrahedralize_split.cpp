// Finer boundaries: long edges are split at their middle, in all triangles around them alike, so that the surface
// stays closed and no point of it moves. A triangle with one, two or three long edges becomes two, three or four.
#include "volume/base/error.h"
#include "volume/mesh/tetrahedralize_repair.h"
#include "volume/mesh/tetrahedralize_shells.h"

#include <Eigen/Geometry>
#include <cmath>

namespace pith::surface {
namespace {

constexpr std::size_t most_triangles = 30'000'000;

/// One pass. Returns whether anything was split.
bool split_once(Repaired& surface, double longest) {
  TriMesh& mesh = surface.mesh;
  const std::vector<EdgeSide> sides = edge_sides(mesh);
  std::vector<VertexId> middle(3 * mesh.triangle_count()); // by 3 · triangle + edge
  bool any = false;
  for_each_edge(sides, [&](const EdgeSide* first, const EdgeSide* last) {
    const Vec3d a = mesh.position[VertexId(first->low)], b = mesh.position[VertexId(first->high)];
    if (!((b - a).norm() > longest)) return;
    const VertexId v(mesh.position.size());
    mesh.position.push_back(0.5 * (a + b));
    for (const EdgeSide* side = first; side < last; ++side) middle[side->corner] = v;
    any = true;
  });
  if (!any) return false;

  Repaired next;
  next.mesh.position.swap(mesh.position);
  const auto distance = [&](VertexId a, VertexId b) {
    return (next.mesh.position[a] - next.mesh.position[b]).squaredNorm();
  };
  for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count())) {
    const auto& c = mesh.corner[t];
    const std::array<VertexId, 3> m = {middle[3 * t], middle[3 * t + 1],
                                       middle[3 * t + 2]}; // m[k] between c[k], c[k+1]
    const auto add = [&](VertexId a, VertexId b, VertexId d) {
      next.mesh.corner.push_back({a, b, d});
      next.source.push_back(surface.source[t]);
    };
    const int count = int(m[0].exists()) + int(m[1].exists()) + int(m[2].exists());
    if (count == 0) {
      add(c[0], c[1], c[2]);
    } else if (count == 3) {
      add(c[0], m[0], m[2]);
      add(m[0], c[1], m[1]);
      add(m[2], m[1], c[2]);
      add(m[0], m[1], m[2]);
    } else if (count == 1) {
      const int k = m[0].exists() ? 0 : m[1].exists() ? 1 : 2;
      add(c[k], m[k], c[(k + 2) % 3]);
      add(m[k], c[(k + 1) % 3], c[(k + 2) % 3]);
    } else {
      // Edges k and k + 1 are split, at p and q; the corner between them is cut off, the rest by its shorter
      // diagonal.
      const int k = !m[0].exists() ? 1 : !m[1].exists() ? 2 : 0;
      const VertexId a = c[k], b = c[(k + 1) % 3], d = c[(k + 2) % 3], p = m[k], q = m[(k + 1) % 3];
      add(p, b, q);
      if (distance(a, q) < distance(p, d)) {
        add(a, p, q);
        add(a, q, d);
      } else {
        add(a, p, d);
        add(p, q, d);
      }
    }
  }
  surface.mesh = std::move(next.mesh);
  surface.source = std::move(next.source);
  return true;
}

} // namespace

void split_long_edges(Repaired& surface, double longest, const std::string& name) {
  // An equilateral triangle of edge `longest` is the most that a triangle can be spared from.
  double area = 0;
  for (const auto& c : surface.mesh.corner) {
    const auto& p = surface.mesh.position;
    area += 0.5 * (p[c[1]] - p[c[0]]).cross(p[c[2]] - p[c[0]]).norm();
  }
  const double least = area / (std::sqrt(3.0) / 4 * longest * longest);
  const auto refuse = [&] {
    throw InvalidInput(name,
                       "a boundary edge of " + std::to_string(longest) + " mm would make more than " +
                           std::to_string(most_triangles / 1'000'000) + " million triangles",
                       "ask for a longer boundary edge");
  };
  if (least > static_cast<double>(most_triangles)) refuse();
  while (split_once(surface, longest))
    if (surface.mesh.triangle_count() > most_triangles) refuse();
}

} // namespace pith::surface
