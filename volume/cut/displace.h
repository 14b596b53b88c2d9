#pragma once
// Displacement: a piece's skin, tessellated and moved outwards by the relief of its material (Takayama 2008, §6; Cook
// 1984), with walls where it meets sections.
#include "volume/cut/surface_subdivide.h"

namespace pith {

struct DisplaceOptions {
  double scale = 1;    ///< of the relief; 0: none
  double max_edge = 0; ///< mm: the skin is tessellated until no edge is longer; 0: 1/400 of the mesh's longest extent
  std::size_t max_triangles = 20'000'000; ///< guard: InvalidInput when the tessellation has more
};

/// Height (mm, 0 or more) of the relief at a rest point of a root facet, in front of the tet behind it. Called from
/// several threads.
using ReliefFunction = std::function<double(const Vec3d& rest, FacetId facet, TetId root)>;

struct DisplacedSurface {
  std::vector<Vec3d> position; ///< of each point, in rest space, where the relief puts it
  std::vector<Vec3d> rest;     ///< where its material lies
  std::vector<SurfaceFace> face;
  std::size_t walls = 0;  ///< the last of the faces: strips between rims
  std::size_t turned = 0; ///< skin faces that now face inwards: the relief is higher than the skin is round
};

/// Moves the points of the skin along its smooth normal (skin_normals, interpolated over the facet) by scale ·
/// height. Skin: root facets with nothing behind them. Everything else, sections and interfaces, stays, bit for bit;
/// where it meets the skin the rim has a second, moved twin, and a strip of faces joins the two, so that a closed
/// surface stays closed. A wall has the tag and the material of the skin at its rim. The direction and the height of
/// a point depend on the root alone, so the skins of two pieces fit together where they were parted. Normals of the
/// skin are then those of its faces, by area, over faces whose normals agreed before; a wall's are flat. `rest` and
/// `face` as in subdivide(). Errors: InvalidInput where subdivide() has one, or an option is not finite or below 0.
/// Cost: linear in the triangles that the tessellation has, a call of `height` for each of its points.
DisplacedSurface displace(std::vector<Vec3d> rest, std::vector<SurfaceFace> face, const TetMesh& mesh,
                          const Boundary& boundary, const ReliefFunction& height,
                          const DisplaceOptions& options = {});

} // namespace pith
