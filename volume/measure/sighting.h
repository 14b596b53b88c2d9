#pragma once
// Which look-ups of a layer are seen at a point, and how much of each: what composite() mixes, told apart.
#include "volume/layer/composite.h"

namespace pith {

/// One look-up that is seen.
struct SeenLookup {
  const Lookup* lookup = nullptr;
  float share = 0;               ///< of what is seen at the point: all shares sum to the coverage
  std::array<float, 4> source{}; ///< exemplar coordinates, not yet wrapped
};

/// Reused from point to point.
struct Sighting {
  std::vector<SeenLookup> seen; ///< only those with a positive share
  float coverage = 0;           ///< after mask and weight
  int masked = 0;               ///< look-ups whose mask and weight are positive there, hidden or not

  /// The one with the largest share (the uppermost of equals); null where nothing is.
  const SeenLookup* dominant() const;
};

/// Fills `sighting` for a point of a tet. The shares follow the blend rule; where a layer selects by height the
/// shares are those before selection. Precondition: the layer is solid.
void look_at(const LayerReader& reader, TetId tet, const std::array<double, 4>& barycentric, Sighting& sighting);

} // namespace pith
