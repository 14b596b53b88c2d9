#pragma once
// How alike pieces are where they mix (private to the lap module).
#include "volume/lap/simplices.h"
#include "volume/layer/layer.h"

namespace pith {

/// Of pairs of look-ups that are both well seen at a point: the correlation of their colours about the exemplar's
/// mean (over the axes blend.mean_over, which varies along the others), in [0, 1]. 0 for pieces that know nothing of
/// each other; pieces brought into line are nearer 1 (Blend::correlation). From some 20,000 points spread over the
/// simplices; 0 where nothing mixes. Precondition: a solid layer of width 3, mixed `over`, its exemplar and
/// blend.mean_over set. Cost: that of a LayerReader.
float correlation_where_mixed(const Simplices& mesh, const Layer& layer);

} // namespace pith
