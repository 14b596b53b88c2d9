// Exact collinearity and self-intersection tests. Candidate pairs come from CGAL's box intersection (Zomorodian and
// Edelsbrunner 2002), the decision from its exact predicates.
#include "volume/mesh/surface_defects_intersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

namespace pith::surface {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box3 = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

Point point_of(const TriMesh& mesh, VertexId v) {
  const Vec3d& p = mesh.position[v];
  return {p.x(), p.y(), p.z()};
}

bool meet(const TriMesh& mesh, TriangleId first, TriangleId second) {
  const auto &a = mesh.corner[first], &b = mesh.corner[second];
  int shared = 0, of_a = 0, of_b = 0; // the last shared corner, or with two shared ones the sum of both
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (a[i] == b[j]) {
        ++shared;
        of_a += i;
        of_b += j;
      }
  const auto corner_a = [&](int i) { return point_of(mesh, a[i % 3]); };
  const auto corner_b = [&](int i) { return point_of(mesh, b[i % 3]); };
  if (shared == 3) return false;
  if (shared == 2) {
    // A fold: both in one plane, on the same side of the common edge. The free corners are 3 − (sum of the shared
    // ones).
    const int free_a = 3 - of_a, free_b = 3 - of_b;
    const Point p = corner_a(free_a + 1), q = corner_a(free_a + 2), c = corner_a(free_a), d = corner_b(free_b);
    return CGAL::coplanar(p, q, c, d) && CGAL::coplanar_orientation(p, q, c, d) == CGAL::POSITIVE;
  }
  const Kernel::Triangle_3 triangle_a(corner_a(0), corner_a(1), corner_a(2)),
      triangle_b(corner_b(0), corner_b(1), corner_b(2));
  if (shared == 1)
    // Whatever else they have in common reaches the edge of one of them that lies opposite the shared corner.
    return CGAL::do_intersect(triangle_a, Kernel::Segment_3(corner_b(of_b + 1), corner_b(of_b + 2))) ||
           CGAL::do_intersect(triangle_b, Kernel::Segment_3(corner_a(of_a + 1), corner_a(of_a + 2)));
  return CGAL::do_intersect(triangle_a, triangle_b);
}

/// Calls body(first, second) for the pairs of triangles whose boxes overlap; collinear ones take no part.
template <class Body>
void for_each_close_pair(const TriMesh& mesh, const PerTriangle<char>& collinear, const Body& body) {
  std::vector<Box3> boxes;
  boxes.reserve(mesh.triangle_count());
  for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count())) {
    if (collinear[t]) continue;
    CGAL::Bbox_3 box;
    for (const VertexId v : mesh.corner[t]) box += point_of(mesh, v).bbox();
    boxes.emplace_back(box, t.value);
  }
  std::vector<const Box3*> pointers;
  for (const Box3& box : boxes) pointers.push_back(&box);
  CGAL::box_self_intersection_d(pointers.begin(), pointers.end(), [&](const Box3* a, const Box3* b) {
    body(TriangleId(a->info()), TriangleId(b->info()));
  });
}

} // namespace

PerTriangle<char> collinear_triangles(const TriMesh& mesh) {
  PerTriangle<char> collinear(mesh.triangle_count(), 0);
  for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count())) {
    const auto& corner = mesh.corner[t];
    collinear[t] =
        CGAL::collinear(point_of(mesh, corner[0]), point_of(mesh, corner[1]), point_of(mesh, corner[2])) ? 1 : 0;
  }
  return collinear;
}

PerTriangle<char> intersecting_triangles(const TriMesh& mesh, const PerTriangle<char>& collinear) {
  PerTriangle<char> found(mesh.triangle_count(), 0);
  for_each_close_pair(mesh, collinear, [&](TriangleId first, TriangleId second) {
    if (found[first] && found[second]) return;
    if (meet(mesh, first, second)) found[first] = found[second] = 1;
  });
  return found;
}

bool parts_cross(const TriMesh& mesh, const PerTriangle<char>& collinear, const PerTriangle<std::uint32_t>& part) {
  bool cross = false;
  for_each_close_pair(mesh, collinear, [&](TriangleId first, TriangleId second) {
    if (!cross && part[first] != part[second] && part[first] != 0 && part[second] != 0)
      cross = meet(mesh, first, second);
  });
  return cross;
}

} // namespace pith::surface
