#pragma once
// The triangles that rays can meet, in rest space, with the normals that make them look smooth.
#include "raytrace/scene.h"

namespace pith {

/// The surface of one piece without the facets at which it touches an unmoved neighbour.
struct VisibleSurface {
  std::uint32_t piece = 0;
  Rigid placement;
  std::vector<Vec3d> position;                  ///< rest space; of the skin where its relief stands
  std::vector<Vec3d> rest;                      ///< where its material lies; empty: the same places
  std::vector<PieceSurface::Triangle> triangle; ///< ascending, as surface_of() lists them
  /// Rows of `normal`, one per corner. Of sections only where nothing is displaced: skin takes its normals from the
  /// root's facets then.
  std::vector<std::array<std::uint32_t, 3>> normal_row;
  std::vector<Vec3f> normal; ///< unit, outwards; rest space
};

/// One per piece, in order; a piece may have no triangle. With `displacement.scale` above 0 the skin of a model that
/// has a relief is displaced; `skin_normal` as of facet_corner_normals.
std::vector<VisibleSurface> visible_surfaces(const Root& root, const Pieces& pieces,
                                             const PerFacet<std::array<Vec3f, 3>>& skin_normal,
                                             const DisplaceOptions& displacement);

/// For each facet of the root, unit normals at its corners: the mean of the facets around the corner whose normals
/// lie within `crease` radians of its own, by area. A function of the root alone, so cuts do not change how the skin
/// looks.
PerFacet<std::array<Vec3f, 3>> facet_corner_normals(const TetMesh& mesh, const Boundary& boundary, double crease);

} // namespace pith
