#pragma once
// Where the thin plate rises beyond the largest depth, or falls below the least (private to the field module).
#include "volume/field/depth_graph.h"

#include <span>

namespace pith {

/// A place and the depth there.
struct DepthPlace {
  Vec3d point;
  double value;
};

/// Further places that hold an interpolant in bounds where it overshoots [0, 1], as it does beside a core that does
/// not lie in the middle (clamping it would leave a plateau: a core as wide as the overshoot). At the worst vertices,
/// each apart from the others by half its distance from the places of the depth that is overshot, and at most `most`
/// of them; their depth falls half as fast from there to the nearest other ones as a linear one. Held vertices and
/// overshoots below `persistence` do not count. `place`: the constraints, with two depths among them.
/// Cost: O(vertices log vertices + most · places).
std::vector<DepthPlace> guards_of(const DepthGraph& graph, const PerVertex<float>& interpolated,
                                  const PerVertex<std::uint8_t>& held, std::span<const DepthPlace> place,
                                  double persistence, std::size_t most);

} // namespace pith
