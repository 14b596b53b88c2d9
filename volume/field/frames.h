#pragma once
// The texture's axes and scale in every tet, for every type of solid texture (Takayama 2008, §5.2.2): S along the
// gradient of depth, T along strokes or the gradient of a second scalar field, R their cross product.
#include "volume/field/depth.h"
#include "volume/field/smooth.h"
#include "volume/mesh/locate.h"

#include <string>

namespace pith {

/// A stroke whose tangent is the texture's T axis near it: a polyline in rest space, on the surface, on a
/// cross-section, or on a layer of equal depth.
struct AxisStroke {
  std::vector<Vec3d> point;
};

/// A place where the texture's scale is multiplied. Factors are interpolated over the region (in their logarithm,
/// Eqs. 1–2, never beyond the least and largest that are given): one alone acts everywhere.
struct ScaleConstraint {
  std::vector<Vec3d> stroke; ///< a polyline in rest space; one point is a point
  double factor = 1;         ///< above 0
};

struct FrameOptions {
  double layer_width = 0.25;    ///< depth difference over which smoothing weakens (SmoothOptions)
  double singular_sine = 0.05;  ///< below this sine between axis and gradient the frame counts as singular
  double vanishing_rise = 0.02; ///< a gradient that rises less over the region's extent counts as vanished (depth)
  double smallest_scale = 0;    ///< clamp of 1/|∇d|, mm; 0: a hundredth of the region's extent
  double largest_scale = 0;     ///< mm; 0: the region's extent (its bounding box's longest side)
  /// Strokes give an axis without a sign (grain, muscle): opposite strokes agree instead of cancelling, and the field
  /// may turn by half a turn around a singular line. The texture must be alike along T and −T. Otherwise each
  /// component of the strokes' vectors is smoothed, as in the paper.
  bool unsigned_axis = false;
};

/// What frames are made of. What is given decides the kind: nothing (type 0), strokes (1-a), depth (1-b), depth and
/// strokes (2-a, 2-b), depth and along (2-c), all three fields (2-d).
struct FrameInput {
  const TetMesh& mesh;
  const Locator& locator;
  std::int32_t region = 0;
  const DepthField* depth = nullptr;    ///< S follows its gradient
  const DepthField* along = nullptr;    ///< T follows its gradient
  const DepthField* around = nullptr;   ///< R should; only judged
  std::span<const AxisStroke> stroke{}; ///< T follows them
  double scale = 0;                     ///< mm per texture width; 0: 1/|∇d|
  std::span<const ScaleConstraint> local_scale{};
  std::string where = "frames"; ///< what messages call the solid (its entry in the recipe); the key is added
};

struct FrameField {
  /// Columns R, S, T: orthonormal, right-handed (R × S = T). S = ∇d / |∇d| points inwards, to greater depth. With
  /// strokes alone T is the axis and R, S some two directions across it; with depth alone S is the axis and R, T some
  /// two. Identity with neither, and in other regions. Singular tets have some such frame too.
  PerTet<Mat3d> axes;
  PerTet<float> scale; ///< mm per texture width: as given, or 1/|∇d| clamped (§5.2.7), times the local factor; 0 in
                       ///< other regions
  /// 1 where the frame is not determined: a gradient vanishes, strokes cancel, gradient and axis are parallel, or the
  /// map of three fields is flat or turned inside out. 0 in other regions.
  PerTet<std::uint8_t> singular;
  SmoothReport smoothing;
};

/// Frames of one region. With depth, strokes spread within its layers more than across (§5.2.2: weights
/// exp(−Δd²)). Samples of strokes further outside the region than a hundredth of its diagonal are left out.
/// Errors: InvalidInput, naming the solid and its key ("…/orientation/1"), when what is given contradicts or lacks
/// something, a stroke has no length or is not finite, none touches the region, a factor is not positive, or the
/// frame is singular in every tet. Cost: O(tets), 2 to 3 smoothings; two of them more for an unsigned axis.
FrameField frames_of(const FrameInput& input, const FrameOptions& options = {});

/// The same for types 2-a and 2-b, with the scale of the latter.
FrameField frames_from_depth(const TetMesh& mesh, const Locator& locator, std::int32_t region,
                             const DepthField& depth, const std::vector<AxisStroke>& strokes,
                             const std::string& where, const FrameOptions& options = {});

/// The singular set of a region: how much of it has no determined frame.
struct SingularSet {
  std::size_t tets = 0;
  double share = 0; ///< of the region's volume
};
SingularSet singular_set(const TetMesh& mesh, std::int32_t region, std::span<const std::uint8_t> singular);

} // namespace pith
