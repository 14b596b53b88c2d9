#pragma once
// The facets where a region of a tet mesh ends: the skin, and the interfaces between regions.
#include "volume/mesh/tet_mesh.h"
#include "volume/mesh/tri_mesh.h"

namespace pith {

/// A view of the facets of a tet mesh that have no tet, or a tet of another region, behind them. An interface between
/// two regions appears once for each side. Facets are numbered by ascending (tet, corner opposite).
struct Boundary {
  PerFacet<TetId> tet;                            ///< the tet that the facet bounds
  PerFacet<std::uint8_t> opposite;                ///< the corner of that tet opposite the facet
  PerFacet<std::array<VertexId, 3>> corner;       ///< counter-clockwise seen from outside the tet
  PerFacet<TetId> behind;                         ///< the tet of the other region; none on the outer skin
  PerFacet<TriangleId> input;                     ///< the input triangle it came from; empty when unknown
  PerTet<std::array<FacetId, 4>> facet_of_tet;    ///< facet opposite corner i; none where there is none

  std::size_t facet_count() const { return tet.size(); }
};

Boundary boundary_of(const TetMesh& mesh);

/// The boundary as a triangle mesh over its own, renumbered vertices; `vertex` maps them back to the tet mesh.
struct BoundarySurface {
  TriMesh surface;
  PerVertex<VertexId> vertex;
};
BoundarySurface surface_of(const TetMesh& mesh, const Boundary& boundary);

/// Area-weighted unit normals at the vertices of the outer skin (facets with nothing behind); zero elsewhere.
PerVertex<Vec3d> skin_normals(const TetMesh& mesh, const Boundary& boundary);

} // namespace pith
