#pragma once
// How fast frames turn from one simplex to the next: where that is fast, the mesh does not resolve their directions.
#include "volume/lap/paste_frames.h"
#include "volume/lap/simplices.h"

namespace pith {

/// Per simplex: the largest angle (radians, 0 … π) between what is fixed of its frame and of a neighbour's. π where
/// `singular` (per simplex, may be empty); 0 where nothing is fixed. Linear in the mesh.
std::vector<float> turning_of(const Simplices& mesh, const FrameSource& frames,
                              std::span<const std::uint8_t> singular);

} // namespace pith
