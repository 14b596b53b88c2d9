#pragma once
// The depth of each region: 0 at its outermost, 1 at its innermost part (Takayama 2008, §5.2.2).
#include "volume/mesh/boundary.h"
#include "volume/mesh/tet_mesh.h"

#include <optional>
#include <string>

namespace pith {

/// The boundary around a place, up to its creases (the paper's multi-face fill).
struct FaceFill {
  Vec3d near = Vec3d::Zero(); ///< at most a hundredth of the region's diagonal from the boundary
  TriangleId triangle;        ///< of the input; when it exists, the fill starts there and not at `near`
  double crease = 0.6;        ///< radians: the fill does not cross an edge where the boundary turns by more, 0 … π
};

/// A set of places with a prescribed depth. At least one of skin, outside, interface, triangles, stroke,
/// fill is given; several add up. Vertices where `outside` and an `interface`, or two interfaces, of different depths
/// meet (the rim of a layer) are left free.
struct DepthConstraint {
  double value = 0;     ///< 0 … 1
  bool skin = false;    ///< the whole boundary of the region, interfaces with other regions included
  bool outside = false; ///< only where nothing lies behind the region's boundary
  std::optional<std::int32_t> interface = {}; ///< only where this region lies behind it
  std::vector<TriangleId> triangles;          ///< these input triangles (single-face fill)
  std::vector<Vec3d> stroke; ///< a polyline in rest space, on the surface or inside; one point is a point
  std::optional<FaceFill> fill = {};
};

struct DepthOptions {
  /// Centres of the radial basis. Strokes take at most half of them; the densest constraints are thinned to the rest
  /// (farthest points). More cost n³ once and n per vertex and tet. 0: 500 as long as there are fewer than 20,000
  /// places; from there on all of them, at near linear cost (radial_basis.h).
  int max_centers = 0;
  double stroke_spacing = 0; ///< mm between samples of a stroke; 0: its length / 40
  /// Levels local extrema that no constraint asks for (depth_extrema.h), as the paper's thin plate has them in
  /// concave solids and beyond the last constraint: the basin of a minimum is raised to where it spills over, the top
  /// of a maximum lowered to where it joins what is higher or held. Levelled places rise (fall) on by less than
  /// `persistence`, away from there. The field keeps its bits everywhere else. False: the paper's field.
  bool remove_extrema = true;
  /// Where the thin plate overshoots [0, 1], as it does beside a core that does not lie in the middle, clamping
  /// leaves a plateau: a core as wide as the overshoot. True: further places there hold it in bounds. Changes the
  /// field in the whole region.
  bool guard_overshoot = false;
  /// Extrema and overshoots that persist by less are let be.
  double persistence = 0.01;
};

struct DepthField {
  PerVertex<float> value; ///< exact where constrained, clamped to [0, 1]; 0 at vertices of other regions
  /// 1/mm, in other regions 0: of the smooth interpolant at the tet's barycentre; where extrema were levelled, of the
  /// linear function through the corners, but at least 0.024 over the region's extent.
  PerTet<Vec3d> gradient;
  std::size_t centers = 0; ///< that the radial basis really has, guards among them
  std::size_t extrema = 0; ///< of the thin plate, that no constraint asks for
};

/// Thin-plate interpolation of the constraints in 3D. `where` names the recipe's field in messages.
/// Errors: InvalidInput when the region has no tets, there is no constraint, all have one value, a value lies outside
/// [0, 1], a constraint names no place of the region (a stroke more than a hundredth of the region's diagonal
/// outside, a triangle that bounds no tet of it, a fill that starts away from its boundary), or two constraints
/// contradict at one place. Cost: ~0.6 ns per core pair of (vertex or tet, centre) on two cores: 4k tets ~7 ms, 1M
/// tets ~0.4 s.
DepthField depth_field(const TetMesh& mesh, const Boundary& boundary, std::int32_t region,
                       const std::vector<DepthConstraint>& constraints, const std::string& where,
                       const DepthOptions& options = {});

} // namespace pith
