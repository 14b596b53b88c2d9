#pragma once
// An evenly spread subset of points.
#include "volume/base/types.h"

#include <span>

namespace pith {

/// Up to `count` indices of `points`, in the order chosen: the first `given` points (in order, at most `count`),
/// then, again and again, the point farthest from all chosen so far; the lowest index among equals. When `given` is 0
/// it starts with point 0. Stops early when every point coincides with a chosen one. O(points · count), in parallel;
/// the same on any number of threads (Gonzalez 1985).
std::vector<std::uint32_t> farthest_points(std::span<const Vec3d> points, std::size_t count, std::size_t given = 0);

} // namespace pith
