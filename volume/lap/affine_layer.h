#pragma once
// Type 2-d: three scalar fields are the texture's coordinates, so that nothing is left to grow, warp or lap.
#include "volume/lap/lap.h"

namespace pith {

/// One look-up without a mask on every tet of the region: the affine map through the corners' coordinates. The
/// exemplar is not set.
Layer affine_layer(const LapInput& input);

} // namespace pith
