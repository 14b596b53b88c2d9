#pragma once
// The depth of each region: 0 at its outermost, 1 at its innermost part (Takayama 2008, §5.2.2).
#include "volume/mesh/boundary.h"
#include "volume/mesh/tet_mesh.h"

#include <string>

namespace pith {

/// A set of places with a prescribed depth.
struct DepthConstraint {
  double value = 0;                    ///< 0 … 1
  bool skin = false;                   ///< the whole boundary of the region
  std::vector<TriangleId> triangles;   ///< these input triangles (multi-face and single-face fill)
  std::vector<Vec3d> stroke;           ///< a polyline in rest space, on the surface or inside
};

struct DepthOptions {
  int max_centers = 1500;      ///< of the radial basis; the densest constraints are thinned to it (farthest points)
  double stroke_spacing = 0;   ///< mm between samples of a stroke; 0: its length / 40
};

struct DepthField {
  PerVertex<float> value;      ///< exact where constrained, clamped to [0, 1]
  PerTet<Vec3d> gradient;      ///< 1/mm: of the smooth interpolant at the tet's barycentre
  std::size_t centers = 0;
};

/// Thin-plate interpolation of the constraints in 3D. Vertices of other regions keep `into`'s values. `where` names the
/// recipe's field in messages.
/// Errors: InvalidInput when there is no constraint, all have one value, a value lies outside [0, 1], two constraints
/// contradict at one place, or a stroke misses the region.
DepthField depth_field(const TetMesh& mesh, const Boundary& boundary, std::int32_t region,
                       const std::vector<DepthConstraint>& constraints, const std::string& where,
                       const DepthOptions& options = {});

} // namespace pith
