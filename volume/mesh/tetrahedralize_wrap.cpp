// The door to CGAL's alpha wrapping and its distance tree.
#include "volume/mesh/tetrahedralize_wrap.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <cmath>

namespace pith::wrap {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

Point point_of(const Vec3d& p) { return {p.x(), p.y(), p.z()}; }

} // namespace

TriMesh wrapped(const TriMesh& mesh, double alpha, double offset) {
  std::vector<Point> points;
  for (const Vec3d& p : mesh.position) points.push_back(point_of(p));
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const auto& c : mesh.corner) triangles.push_back({c[0], c[1], c[2]});
  CGAL::Surface_mesh<Point> wrap;
  TriMesh result;
  try {
    CGAL::alpha_wrap_3(points, triangles, alpha, offset, wrap);
  } catch (const std::exception&) { // a broken precondition: there is no wrap
    return result;
  }
  wrap.collect_garbage();
  for (const auto v : wrap.vertices()) {
    const Point& p = wrap.point(v);
    result.position.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : wrap.faces()) {
    std::array<VertexId, 3> corner;
    auto h = wrap.halfedge(f);
    for (VertexId& v : corner) {
      v = VertexId(static_cast<std::uint32_t>(wrap.target(h)));
      h = wrap.next(h);
    }
    result.corner.push_back(corner);
  }
  return result;
}

namespace {

/// Calls body(point, squared distance to `to`) for the vertices in use and the triangle centres of `from`.
template <class Body>
void for_each_sample(const TriMesh& from, const TriMesh& to, const Body& body) {
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Kernel::Triangle_3>::const_iterator>;
  std::vector<Kernel::Triangle_3> triangles;
  for (const auto& c : to.corner)
    triangles.emplace_back(point_of(to.position[c[0]]), point_of(to.position[c[1]]), point_of(to.position[c[2]]));
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree(triangles.begin(), triangles.end());
  tree.accelerate_distance_queries();
  const auto measure = [&](const Vec3d& p) { body(p, CGAL::to_double(tree.squared_distance(point_of(p)))); };
  PerVertex<char> used(from.vertex_count(), 0);
  for (const auto& c : from.corner) {
    for (const VertexId v : c) used[v] = 1;
    measure((from.position[c[0]] + from.position[c[1]] + from.position[c[2]]) / 3);
  }
  for (const VertexId v : all_ids<VertexId>(from.vertex_count()))
    if (used[v]) measure(from.position[v]);
}

} // namespace

double largest_distance(const TriMesh& from, const TriMesh& to) {
  double largest = 0;
  for_each_sample(from, to, [&](const Vec3d&, double squared) { largest = std::max(largest, squared); });
  return std::sqrt(largest);
}

std::vector<Vec3d> samples_farther(const TriMesh& from, const TriMesh& to, double distance) {
  std::vector<Vec3d> found;
  for_each_sample(from, to, [&](const Vec3d& p, double squared) {
    if (squared > distance * distance) found.push_back(p);
  });
  return found;
}

} // namespace pith::wrap
