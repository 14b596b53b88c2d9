#pragma once
// Vertices around which the frames turn: those of a singular axis, at which pieces from all around it meet.
#include "volume/lap/paste_frames.h"
#include "volume/lap/simplices.h"

namespace pith {

/// Per vertex: 1 where some fixed axis, over the simplices around the vertex, has a mean shorter than 0.7 (an even
/// fan of half a turn has 0.64), or where a simplex around it is singular. `singular` is per simplex and may be
/// empty. Linear in the mesh.
std::vector<std::uint8_t> pivots_of(const Simplices& mesh, const FrameSource& frames,
                                    std::span<const std::uint8_t> singular);

} // namespace pith
