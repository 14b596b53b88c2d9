#pragma once
// How far the look-ups' maps stray from what the fields ask for: each should carry the axes R, S, T, times the local
// scale, to the exemplar's unit axes (Takayama 2008, §5.2.5: the warp minimises ‖J·[R S T] − I‖).
#include "volume/base/parallel.h"
#include "volume/layer/model.h"
#include "volume/measure/points.h"

#include <optional>

namespace pith {

/// With J the gradients of a look-up's exemplar coordinates (rows), F = [R S T] and s the mm per texture width of its
/// tet: A = s·J·F, the identity where the map is perfect. Quantiles are weighted by the volume in which a look-up is
/// seen; tets with a singular frame are left out.
struct DistortionMeasure {
  std::size_t lookups = 0;          ///< seen, outside singular tets
  std::array<Spread, 3> axis_angle; ///< degrees between row k of J and axis k
  std::array<Spread, 3> axis_scale; ///< |log₂| of row k's length times s: 1 is a factor of two either way
  Spread departure;                 ///< ‖A − I‖ (Frobenius)
  Spread symmetric_dirichlet;       ///< (‖A‖² + ‖A⁻¹‖²)/6: 1 for a rotation
  Spread angle;                     ///< degrees by which two of the three texture axes, at worst, miss a right angle
  Spread volume;                    ///< |log₂ det A|
  std::size_t inverted = 0;         ///< look-ups with det A ≤ 0, whether seen or not, singular tets included
  std::size_t inverted_regular = 0; ///< of those, outside singular tets
  double inverted_seen_share = 0;   ///< of the filled volume, where an inverted look-up shows
  Vec3d first_inverted = Vec3d::Zero(); ///< the barycentre of the lowest tet with one
  std::size_t singular_tets = 0;
  double singular_share = 0; ///< of the filled volume
};

/// O(look-ups). None when the model has no frames or scales, or the layer is not a solid one of three axes.
std::optional<DistortionMeasure> distortion_measure(const Model& model, const Layer& layer);

} // namespace pith
