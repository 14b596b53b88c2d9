#pragma once
// Inside volume/mesh: what can be mended without moving the surface.
#include "volume/mesh/tri_mesh.h"

#include <string>

namespace pith::surface {

/// A surface made ready for meshing, and where each of its triangles comes from.
struct Repaired {
  TriMesh mesh;                   ///< `part` is empty
  PerTriangle<TriangleId> source; ///< for each triangle the input triangle that it lies in
  std::string note;               ///< what was mended, in words; empty when nothing was
};

/// Merges vertices of equal position; drops triangles whose corners lie on one line (flipping the edge that the
/// middle corner lies on) and all but the first of triangles with the same corners; orients each closed manifold
/// shell consistently. Positions must be finite. A shell that was oriented consistently keeps its orientation; a
/// scrambled one comes out facing outwards. No point of the surface moves. O(n log n).
Repaired repaired(const TriMesh& mesh);

/// Splits edges longer than `longest` (mm) at their middle, again and again, without moving the surface. Throws
/// InvalidInput, naming `name`, when that would make more than 30 million triangles.
void split_long_edges(Repaired& surface, double longest, const std::string& name);

} // namespace pith::surface
