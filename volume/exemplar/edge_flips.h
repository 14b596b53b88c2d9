#pragma once
// Flips of edges towards well-shaped triangles (Lawson 1977). Internal to the shapes.
#include "volume/base/types.h"

namespace pith {

/// Which edges a sweep flips: those that bring valences nearer to six, or those that fail the Delaunay condition and
/// keep valences within 5 to 7.
enum class FlipFor { valence, delaunay };

/// One sweep of flips over all edges of a closed surface; returns how many edges were flipped. A flip never makes an
/// edge that exists, nor turns a triangle by more than 60 degrees against those it replaces. O(n log n).
int flip_edges(FlipFor aim, const std::vector<Vec3d>& position, std::vector<std::array<std::uint32_t, 3>>& corner);

} // namespace pith
