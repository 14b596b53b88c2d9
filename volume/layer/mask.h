#pragma once
// Where in an exemplar a paste is opaque: an image or volume of alpha, 0 outside [0, 1].
#include "volume/base/types.h"

namespace pith {

/// 8-bit alpha over the unit square or cube of a patch, first axis fastest, centres as in Exemplar. Interpolated
/// linearly; 0 outside [0, 1] along every axis that is not `open`. Along an open axis it is extended by its border value.
struct Mask {
  int axes = 3;
  std::array<int, 3> size{1, 1, 1};
  std::array<bool, 3> open{false, false, false};
  std::vector<std::uint8_t> alpha;

  /// Alpha in [0, 1] at a position; reads `axes` numbers.
  float value(const float* position) const;
};

/// The three splotch masks of depth-varying textures (Takayama 2008, §5.2.7, Fig. 14) share one shape.
enum class SplotchPart { whole, outer, middle, inner };

struct SplotchOptions {
  int axes = 3;
  int resolution = 32;           ///< texels along each axis
  double radius = 0.42;          ///< of the splotch across the axis of variation, in texture widths
  double radius_along = 0.30;    ///< half its extent along the axis of variation (outer, middle, inner only)
  double drop_off = 0.08;        ///< width of the alpha ramp, in texture widths (paper: 0.05–0.10)
  double irregularity = 0.06;    ///< amplitude of the border's waviness, in texture widths
  int variation_axis = 1;        ///< the axis along which outer/middle/inner differ (depth)
  std::uint64_t seed = 1;
};

/// A splotch: an irregular ellipsoid, opaque inside, falling to 0 over the drop-off. `outer` sits at the low end of the
/// variation axis and is open (opaque) beyond it, `inner` at the high end, `middle` between (§5.2.1, Fig. 11).
Mask splotch_mask(const SplotchOptions& options, SplotchPart part = SplotchPart::whole);

} // namespace pith
