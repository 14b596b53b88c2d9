#pragma once
// The triangles that rays can meet, in rest space, with the normals that make them look smooth.
#include "raytrace/scene.h"

namespace pith {

/// The surface of one piece without the facets at which it touches an unmoved neighbour.
struct VisibleSurface {
  std::uint32_t piece = 0;
  Rigid placement;
  std::vector<Vec3d> position;                  ///< rest space
  std::vector<PieceSurface::Triangle> triangle; ///< ascending, as surface_of() lists them
  /// Sections only: rows of `normal`, one per corner; skin takes its normals from the root's facets.
  std::vector<std::array<std::uint32_t, 3>> normal_row;
  std::vector<Vec3f> normal; ///< unit, outwards; rest space
};

/// One per piece, in order; a piece may have no triangle.
std::vector<VisibleSurface> visible_surfaces(const Root& root, const Pieces& pieces);

/// For each facet of the root, unit normals at its corners: the mean of the facets around the corner whose normals
/// lie within `crease` radians of its own, by area. A function of the root alone, so cuts do not change how the skin
/// looks.
PerFacet<std::array<Vec3f, 3>> facet_corner_normals(const TetMesh& mesh, const Boundary& boundary, double crease);

} // namespace pith
