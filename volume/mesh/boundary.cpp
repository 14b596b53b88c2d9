// The facets where a region ends, and their surface.
#include "volume/mesh/boundary.h"

#include <Eigen/Geometry>

namespace pith {

Boundary boundary_of(const TetMesh& mesh) {
  Boundary boundary;
  boundary.facet_of_tet.assign(mesh.tet_count(), {});
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    for (int i = 0; i < 4; ++i) {
      const TetId behind = mesh.neighbor[t][i];
      if (behind.exists() && mesh.region[behind] == mesh.region[t]) continue;
      boundary.facet_of_tet[t][i] = FacetId(boundary.tet.size());
      boundary.tet.push_back(t);
      boundary.opposite.push_back(static_cast<std::uint8_t>(i));
      boundary.behind.push_back(behind);
      const auto& corner = mesh.corner[t];
      boundary.corner.push_back(
          {corner[facet_corners[i][0]], corner[facet_corners[i][1]], corner[facet_corners[i][2]]});
    }
  return boundary;
}

BoundarySurface surface_of(const TetMesh& mesh, const Boundary& boundary) {
  BoundarySurface result;
  PerVertex<VertexId> number(mesh.vertex_count());
  for (const auto& corner : boundary.corner)
    for (const VertexId v : corner) number[v] = VertexId(0u);
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count())) {
    if (!number[v].exists()) continue;
    number[v] = VertexId(result.vertex.size());
    result.vertex.push_back(v);
    result.surface.position.push_back(mesh.position[v]);
  }
  result.surface.corner.reserve(boundary.facet_count());
  result.surface.part.reserve(boundary.facet_count());
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) {
    const auto& corner = boundary.corner[f];
    result.surface.corner.push_back({number[corner[0]], number[corner[1]], number[corner[2]]});
    result.surface.part.push_back(mesh.region[boundary.tet[f]]);
  }
  return result;
}

PerVertex<Vec3d> skin_normals(const TetMesh& mesh, const Boundary& boundary) {
  PerVertex<Vec3d> normal(mesh.vertex_count(), Vec3d::Zero());
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) {
    if (boundary.behind[f].exists()) continue;
    const auto& corner = boundary.corner[f];
    const Vec3d &a = mesh.position[corner[0]], &b = mesh.position[corner[1]], &c = mesh.position[corner[2]];
    const Vec3d area = (b - a).cross(c - a);
    for (const VertexId v : corner) normal[v] += area;
  }
  for (Vec3d& n : normal) {
    const double length = n.norm();
    n = length > 0 ? Vec3d(n / length) : Vec3d::Zero();
  }
  return normal;
}

} // namespace pith
