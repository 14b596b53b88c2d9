#pragma once
// Takes spurious extrema out of a depth field (private to the field module).
#include "volume/field/depth_graph.h"

namespace pith {

struct LevelledDepth {
  PerVertex<float> depth; ///< may lie beyond [0, 1] by less than the persistence
  double slope;           ///< 1/mm, with which levelled places begin to rise
};

/// Levels the extrema that extrema_of finds (depth_extrema.h), and nothing else: the basin of a minimum is raised to
/// where it spills over, the top of a maximum lowered to where it joins what outlasts it. So that the levelled places
/// are no plateaus, depth goes on rising (falling) there with the distance from that vertex, by less than
/// `persistence` in all; where this overtakes vertices around them, these are levelled, too. All other vertices keep
/// their bits, the held ones among them. Parts of the region without a held vertex are let be.
/// Cost: O(n log n). The same bits on any number of threads.
LevelledDepth without_extrema(const DepthGraph& graph, const PerVertex<float>& depth,
                              const PerVertex<std::uint8_t>& held, double persistence);

} // namespace pith
