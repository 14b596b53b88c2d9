#pragma once
// Triangles split until no edge is longer than a length, without cracks.
#include "volume/cut/piece.h"

#include <functional>

namespace pith {

/// A triangle of a piece's surface with what its colours and shading need. Points are rows of a table in rest space.
struct SurfaceFace {
  std::array<std::uint32_t, 3> point;
  std::array<Vec3f, 3> normal; ///< unit, rest space
  TetId root;
  FaceTag tag;
};

/// An edge is split at its midpoint iff it is longer than `max_edge` (decided per edge, so neighbours always agree),
/// in rounds until none is; with `asks`, only edges of faces for which that is true (those beside them follow).
/// Midpoints are appended to `position`; normals there are the mean of the ends'. Faces of one original triangle stay
/// together. InvalidInput, naming `where`, when more than `max_triangles` would result.
void subdivide(std::vector<Vec3d>& position, std::vector<SurfaceFace>& face, double max_edge,
               std::size_t max_triangles, const std::function<bool(const SurfaceFace&)>& asks = {},
               const char* where = "max_edge");

} // namespace pith
