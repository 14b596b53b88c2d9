#pragma once
// Where in an exemplar a paste is opaque: an image or volume of alpha, 0 outside [0, 1].
#include "volume/base/types.h"

namespace pith {

/// 8-bit alpha over the unit square or cube of a patch, first axis fastest, centres as in Exemplar. Interpolated
/// linearly; 0 outside [0, 1] along every axis that is not `open`. Along an open axis it is extended by its border
/// value.
struct Mask {
  int axes = 3;
  std::array<int, 3> size{1, 1, 1};
  std::array<bool, 3> open{false, false, false};
  LargeArray<std::uint8_t> alpha;

  /// True when the texel that holds the position is not 0: cheaper than MaskGrid::alpha() (sample.h).
  bool touches(const double* position) const {
    std::size_t index = 0, stride = 1;
    for (int axis = 0; axis < axes; ++axis) {
      const double p = position[axis];
      if (!open[axis] && !(p >= 0 && p <= 1)) return false;
      const double at = p * size[axis];
      index += stride * (at > 0 ? (at < size[axis] - 1 ? static_cast<std::size_t>(at) : size[axis] - 1) : 0);
      stride *= size[axis];
    }
    return alpha[index] != 0;
  }
};

/// The three splotch masks of depth-varying textures (Takayama 2008, §5.2.7, Fig. 14) share one shape.
enum class SplotchPart { whole, outer, middle, inner };

struct SplotchOptions {
  int axes = 3;
  int resolution = 40;        ///< texels along each axis
  double radius = 0.40;       ///< of the splotch across the axis of variation, in texture widths
  double radius_outer = 0.7;  ///< the same for the outer part, whose layers bend least
  double radius_along = 0.46; ///< half the middle part's extent along the axis of variation
  double reach_outer = 0.36;  ///< how far the outer part reaches from the low end of that axis
  double reach_inner = 0.28;  ///< how far the inner part reaches from its high end
  double drop_off = 0.09;     ///< width of the alpha ramp, in texture widths (paper: 0.05–0.10)
  double irregularity = 0.06; ///< amplitude of the border's waviness, in texture widths
  int variation_axis = 1;     ///< the axis along which outer/middle/inner differ (depth)
  /// An axis along which the splotch does not end (another coordinate that is imposed, type 2-c); −1: none. The
  /// border still waves along it.
  int endless_axis = -1;
  std::uint64_t seed = 1;
};

/// Texture widths that the mask's unit square or cube spans along the axes across the variation: room for the splotch
/// and its waviness. More than 1 where the splotch is larger than the exemplar, which then repeats under it.
double splotch_extent(const SplotchOptions& options, SplotchPart part);

/// A splotch: an irregular ellipsoid, opaque inside, falling to 0 over the drop-off. `outer` sits at the low end of
/// the variation axis and is open (opaque) beyond it, `inner` at the high end, `middle` between (§5.2.1, Fig. 11).
/// Errors: InvalidInput for sizes that are not positive, a resolution outside 4 to 256, an axis that does not exist.
Mask splotch_mask(const SplotchOptions& options, SplotchPart part = SplotchPart::whole);

} // namespace pith
