#pragma once
// A thing to paste: a seed, a nut, a stone. A volume that is opaque somewhere in its cube and nothing outside.
#include "volume/layer/layer.h"

#include <optional>

namespace pith {

/// Which cells of a patch's unit cube hold alpha: a coarse, conservative picture of a mask.
struct Occupancy {
  static constexpr int cells = 16; ///< along each axis
  std::vector<std::uint8_t> cell;  ///< cells³, first axis fastest; 1 where the mask exceeds the threshold
  Box bounds;                      ///< of the cells that do, in the unit cube

  /// Whether some occupied cell meets the tet with these corners (in the unit cube's coordinates). Conservative: may
  /// say yes where a cell comes near a corner or an edge. `corners` is 4 for a tet; 3 for a triangle.
  bool meets(const std::array<Vec3d, 4>& corner, int corners = 4) const;
};

/// Cells in which the interpolated mask exceeds `above` somewhere.
Occupancy occupancy_of(const Mask& mask, std::uint8_t above);

/// A thing, ready to be pasted.
struct Thing {
  Exemplar
      exemplar;  ///< without its alpha channel; colours continued outwards, so that no border shows another colour
  Mask mask;     ///< its alpha
  AxisMap frame; ///< from the mask's cube to the exemplar
  Box solid;     ///< of what is at least half opaque, in the mask's cube
  double volume = 0; ///< ∫ alpha over the mask's cube
  Occupancy any;     ///< where alpha is above 0
  Occupancy half;    ///< where alpha is at least ½
};

/// The name of the channel that says where a thing is.
inline constexpr const char* alpha_channel = "alpha";

/// Makes a thing of an exemplar with three axes. With a channel "alpha" (scalar, one component) that is the mask;
/// otherwise `splotch` says what is cut out of the exemplar. Errors: InvalidInput for an exemplar that is no volume,
/// that has nothing but alpha, whose alpha is nowhere at least ½, or that has neither alpha nor a splotch.
Thing thing_of(const Exemplar& exemplar, const std::optional<SplotchOptions>& splotch = {});

} // namespace pith
