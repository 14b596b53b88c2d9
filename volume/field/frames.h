#pragma once
// The texture's axes in every tet: S along the depth gradient, the second axis from strokes, the third their cross
// product (Takayama 2008, §5.2.2).
#include "volume/field/depth.h"
#include "volume/field/smooth.h"
#include "volume/mesh/locate.h"

#include <string>

namespace pith {

/// A stroke whose tangent is the texture's T axis near it: a polyline in rest space.
struct AxisStroke {
  std::vector<Vec3d> point;
};

struct FrameOptions {
  double layer_width = 0.25;    ///< depth difference over which smoothing weakens (SmoothOptions)
  double singular_sine = 0.05;  ///< below this sine between axis and gradient the frame counts as singular
  double vanishing_rise = 0.02; ///< a gradient that rises less over the region's extent counts as vanished (depth)
  double smallest_scale = 0;    ///< clamp of 1/|∇d|, mm; 0: a hundredth of the region's extent
  double largest_scale = 0;     ///< mm; 0: the region's extent (its bounding box's longest side)
};

struct FrameField {
  /// Columns R, S, T: orthonormal, right-handed (R × S = T). S = ∇d / |∇d| points inwards, to greater depth. Singular
  /// tets have some such frame too. Identity in other regions.
  PerTet<Mat3d> axes;
  PerTet<float> scale; ///< mm per texture width: 1/|∇d| clamped (§5.2.7); 0 in other regions
  PerTet<std::uint8_t>
      singular; ///< 1 where gradient and axis are parallel, or one of them vanishes; 0 in other regions
  SmoothReport smoothing;
};

/// Frames of one region for types 2-a and 2-b. Samples of strokes further outside the region than a hundredth of its
/// diagonal are left out. Errors: InvalidInput when there is no stroke, one has no length or is not finite, none
/// touches the region, or the frame is singular in every tet; `where` names the recipe's field.
FrameField frames_from_depth(const TetMesh& mesh, const Locator& locator, std::int32_t region,
                             const DepthField& depth, const std::vector<AxisStroke>& strokes,
                             const std::string& where, const FrameOptions& options = {});

} // namespace pith
