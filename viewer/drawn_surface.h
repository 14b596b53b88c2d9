#pragma once
// The triangles that are drawn, three vertices each, with what a fragment needs to ask for its material: where it is
// in which root tet and root facet. No GL in here.
#include "volume/cut/displace.h"
#include "volume/cut/piece.h"
#include "volume/layer/model.h"

#include <optional>

namespace pith {

/// As it lies in a vertex buffer.
struct DrawnVertex {
  std::array<float, 3> position; ///< rest space, mm
  std::array<float, 3> normal;   ///< unit, outwards, rest space
  std::array<float, 3> in_tet;   ///< barycentric coordinates in `tet`, of corners 0, 1, 2
  std::array<float, 2> in_facet; ///< the same in `facet`, of corners 0 and 1
  std::uint32_t tet;             ///< of the root
  std::uint32_t facet;           ///< of the root's boundary; 0xffffffff on a section
  std::int32_t region;
};

struct DrawnPiece {
  std::uint32_t piece = 0;
  Rigid placement;
  std::size_t begin = 0, end = 0; ///< vertices
};

struct DrawnSurface {
  LargeArray<DrawnVertex> vertex;
  std::vector<DrawnPiece> piece;
  std::vector<FaceTag> tag; ///< of each triangle
};

/// What can be seen of the pieces (visible_surfaces). `skin_normal`: facet_corner_normals of the root.
DrawnSurface drawn_surface(const Root& root, const Pieces& pieces, const PerFacet<std::array<Vec3f, 3>>& skin_normal,
                           const DisplaceOptions& displacement);

/// Where a ray meets what is drawn.
struct SurfaceHit {
  double distance = 0;     ///< along the ray, mm
  std::uint32_t piece = 0; ///< number
  std::uint32_t triangle = 0;
  Vec3d world, rest; ///< the point where it stands, and at rest
  Vec3d normal;      ///< world, unit, smooth
  TetId tet;         ///< the root tet behind it
  FacetId facet;     ///< none on a section
  FaceTag tag;
};

/// The nearest hit, from either side. Tests every triangle: 1 ms for 100,000 on two cores.
std::optional<SurfaceHit> nearest_hit(const DrawnSurface& surface, const Vec3d& origin, const Vec3d& direction);

} // namespace pith
