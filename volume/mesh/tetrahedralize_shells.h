#pragma once
// Inside volume/mesh: the edges and shells of a surface, and which shell lies in which.
#include "volume/base/disjoint_sets.h"
#include "volume/mesh/tri_mesh.h"

#include <optional>

namespace pith::surface {

/// One triangle's side of an undirected edge (low < high).
struct EdgeSide {
  std::uint32_t low, high;
  std::uint32_t corner; ///< 3 · triangle + k: the edge runs from corner k to corner k + 1
  bool forward;         ///< the triangle runs from low to high
};

/// All sides, sorted by (low, high, corner). Triangles with a repeated corner have none.
std::vector<EdgeSide> edge_sides(const TriMesh& mesh);

/// Calls body(first, last) for the sides of every edge.
template <class Body>
void for_each_edge(const std::vector<EdgeSide>& sides, const Body& body) {
  for (std::size_t at = 0; at < sides.size();) {
    std::size_t end = at + 1;
    while (end < sides.size() && sides[end].low == sides[at].low && sides[end].high == sides[at].high) ++end;
    body(sides.data() + at, sides.data() + end);
    at = end;
  }
}

/// Which vertices are held together by nothing but themselves: their triangles form more than one fan.
PerVertex<char> torn_vertices(const TriMesh& mesh, const std::vector<EdgeSide>& sides);

/// A connected component of a surface (through edges), numbered by its first triangle.
struct Shell {
  std::vector<TriangleId> triangle;
  Box box;
  double volume = 0;                   ///< signed
  bool closed = true;                  ///< every edge has two triangles that run through it in opposite directions
  std::uint32_t depth = 0;             ///< how many closed shells it lies in
  std::optional<std::uint32_t> parent; ///< the innermost of them
};
std::vector<Shell> shells_of(const TriMesh& mesh, const std::vector<EdgeSide>& sides);

/// How often a closed shell winds around a point that does not lie on it: the sum of the triangles' solid angles over
/// 4π (van Oosterom and Strackee 1983). 1 inside a shell that faces outwards, −1 inside one turned inside out, 0
/// outside.
double winding_number(const TriMesh& mesh, const Shell& shell, const Vec3d& point);

} // namespace pith::surface
