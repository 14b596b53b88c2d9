#pragma once
// Makes an exemplar that was measured somewhere (a CT scan, a photograph) repeat without a seam: its ends are laid
// over one another and blended so that the distribution of its values stays (Heitz, Neyret: High-Performance
// By-Example Noise using a Histogram-Preserving Blending Operator, HPG 2018).
#include "volume/layer/exemplar.h"

namespace pith {

struct TileOptions {
  std::array<bool, 3> axis{true, true, true}; ///< along which it shall repeat
  double border = 0.25; ///< part of each of these axes that is laid over its other end; above 0, to 0.5
};

/// The exemplar with Wrap::repeat along the axes asked for. Along each of n texels its last b = border · n are
/// blended into its first b, so that n − b are left. Values are ranked and made Gaussian (each component by itself;
/// values that occur often by the mean around them, so that a volume of two values keeps the shares of both), blended
/// with weights whose squares sum to 1, and mapped back; what is not blended stays as it was, bit for bit. Structure
/// longer than the border is cut there. Errors: InvalidInput, at `where`, for a border out of range, an axis that the
/// exemplar has not, fewer than 4 texels along one, and channels of directions or normals. O(n log n), ~1 s for 128³
/// texels.
Exemplar tiled(const Exemplar& exemplar, const TileOptions& options = {}, const std::string& where = "exemplar");

} // namespace pith
