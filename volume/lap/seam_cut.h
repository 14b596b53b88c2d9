#pragma once
// Seams that follow the texture: the border of each piece of a finished fill runs where it matches what lies beneath,
// or along edges that are there anyway, such as the joints of brickwork. A minimum cut through the mask's volume
// after Kwatra, Schödl, Essa, Turk, Bobick: Graphcut Textures (SIGGRAPH 2003), §3; beyond Takayama 2008, whose pieces
// all have one of a few outlines and who names structured textures as a limitation (§7).
#include "volume/base/parallel.h"
#include "volume/lap/coverage.h"
#include "volume/layer/layer.h"

namespace pith {

/// Gives every patch a mask of its own, as fine as the one it had, that is opaque on one side of the cut and falls to
/// nothing within two texels. A texel is kept where nothing beneath covers it and in the core of the piece (the inner
/// half of its mask), and dropped where it was transparent. Then takes away look-ups that no longer show.
/// Preconditions: a solid layer of width 3 whose patches all have a mask, mixed `over`, with its exemplar;
/// `coverage`: of the same simplices, with nothing covered yet; what the layer covers there stays covered. The more
/// pieces overlap, the freer is the cut: look-ups beneath opaque pieces are not in vain. Cost: per patch a composite
/// and 14 edges for each texel of its mask; memory: the masks. The same for any number of threads.
/// Errors: Cancelled.
void cut_seams(const Simplices& mesh, Coverage coverage, Layer& layer, const Progress& progress = {});

} // namespace pith
