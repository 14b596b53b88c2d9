#pragma once
// The input surface: an indexed triangle mesh, and what may be wrong with it.
#include "volume/base/types.h"

#include <string>

namespace pith {

/// Triangles over shared vertices. Closed input surfaces are oriented outwards (counter-clockwise seen from outside).
struct TriMesh {
  PerVertex<Vec3d> position;                        ///< millimetres
  PerTriangle<std::array<VertexId, 3>> corner;
  PerTriangle<std::int32_t> part;                   ///< group or material of the file, 0 where it has none; may be empty

  std::size_t vertex_count() const { return position.size(); }
  std::size_t triangle_count() const { return corner.size(); }
};

Box bounds_of(const TriMesh& mesh);

/// Enclosed volume by the divergence theorem; negative where the surface is inside out.
double signed_volume(const TriMesh& mesh);

/// Merges vertices of bit-identical position, drops triangles that lose a corner and vertices that nothing uses.
/// Order of the survivors is kept.
TriMesh welded(const TriMesh& mesh);

/// Counts of what stands between a surface and a tet mesh (see `surface_defects`).
struct SurfaceDefects {
  std::size_t non_finite_vertices = 0;
  std::size_t degenerate_triangles = 0;   ///< zero area, or a repeated corner
  std::size_t duplicate_triangles = 0;
  std::size_t border_edges = 0;           ///< edges with one triangle: the surface is open there
  std::size_t non_manifold_edges = 0;     ///< edges with more than two triangles
  std::size_t non_manifold_vertices = 0;  ///< vertices whose triangles form more than one fan
  std::size_t misoriented_edges = 0;      ///< edges that both their triangles run through in the same direction
  std::size_t self_intersecting_triangles = 0;
  std::size_t shells = 0;                 ///< connected components
  std::size_t inside_out_shells = 0;      ///< outermost shells of negative volume
  double volume = 0;                      ///< mm³, signed
  Vec3d first_defect = Vec3d::Zero();     ///< a place to look at, when any count is not zero

  /// Closed, manifold, oriented, free of self-intersections, with a volume: TetGen can take it as it is.
  bool clean() const;
  /// The findings in words, for an error message: "12 border edges, 3 non-manifold edges, near (1.2, 3.4, 5.6)".
  std::string summary() const;
};

/// Everything above; O(n log n). The self-intersection test runs only when vertices are finite.
SurfaceDefects surface_defects(const TriMesh& mesh);

} // namespace pith
