#pragma once
// The depth of each region: 0 at its outermost, 1 at its innermost part (Takayama 2008, §5.2.2).
#include "volume/mesh/boundary.h"
#include "volume/mesh/tet_mesh.h"

#include <optional>
#include <string>

namespace pith {

/// A set of places with a prescribed depth. At least one of skin, outside, interface, triangles, stroke is given;
/// several add up. Vertices where `outside` and an `interface`, or two interfaces, of different depths meet (the rim
/// of a layer) are left free.
struct DepthConstraint {
  double value = 0;     ///< 0 … 1
  bool skin = false;    ///< the whole boundary of the region, interfaces with other regions included
  bool outside = false; ///< only where nothing lies behind the region's boundary
  std::optional<std::int32_t> interface = {}; ///< only where this region lies behind it
  std::vector<TriangleId> triangles;          ///< these input triangles (multi-face and single-face fill)
  std::vector<Vec3d> stroke; ///< a polyline in rest space, on the surface or inside; one point is a point
};

struct DepthOptions {
  /// Centres of the radial basis. Strokes take at most half of them; the densest constraints are thinned to the rest
  /// (farthest points). More cost n³ once and n per vertex and tet.
  int max_centers = 500;
  double stroke_spacing = 0; ///< mm between samples of a stroke; 0: its length / 40
};

struct DepthField {
  PerVertex<float> value;  ///< exact where constrained, clamped to [0, 1]; 0 at vertices of other regions
  PerTet<Vec3d> gradient;  ///< 1/mm: of the smooth interpolant at the tet's barycentre; 0 in other regions
  std::size_t centers = 0; ///< that the radial basis really has
};

/// Thin-plate interpolation of the constraints in 3D. `where` names the recipe's field in messages.
/// Errors: InvalidInput when the region has no tets, there is no constraint, all have one value, a value lies outside
/// [0, 1], a constraint names no place of the region (a stroke more than a hundredth of the region's diagonal
/// outside, a triangle that bounds no tet of it), or two constraints contradict at one place. Cost: ~0.6 ns per core
/// pair of (vertex or tet, centre) on two cores: 4k tets ~7 ms, 1M tets ~0.4 s.
DepthField depth_field(const TetMesh& mesh, const Boundary& boundary, std::int32_t region,
                       const std::vector<DepthConstraint>& constraints, const std::string& where,
                       const DepthOptions& options = {});

} // namespace pith
