#pragma once
// Strokes as polylines: even samples along them, and nearness to a region of a mesh.
#include "volume/mesh/tet_mesh.h"

#include <span>

namespace pith {

double length_of(std::span<const Vec3d> polyline);

struct PolylineSample {
  Vec3d point;
  Vec3d tangent; ///< unit vector of the segment that holds the sample; zero on a polyline without length
};

/// Samples at equal arc lengths, at most `spacing` apart, both ends included. One sample when the polyline has no
/// length. At most 100,000 steps. Errors: InvalidInput where the length is not finite.
std::vector<PolylineSample> evenly_sampled(std::span<const Vec3d> polyline, double spacing);

double squared_distance(const Vec3d& x, const Vec3d& a, const Vec3d& b); ///< from x to the segment ab

/// For each point whether it lies in a tet of the region or (near enough: outside no facet plane of some tet) within
/// `margin` of one. O(points · tets) box tests, in parallel.
std::vector<std::uint8_t> near_region(const TetMesh& mesh, std::int32_t region, std::span<const Vec3d> points,
                                      double margin);

} // namespace pith
