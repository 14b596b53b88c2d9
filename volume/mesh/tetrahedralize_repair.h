#pragma once
// Inside volume/mesh: what can be mended without moving the surface.
#include "volume/mesh/tri_mesh.h"

#include <string>

namespace pith::surface {

/// A surface made ready for meshing, and where each of its triangles comes from.
struct Repaired {
  TriMesh mesh; ///< `part` is empty
  PerTriangle<TriangleId>
      source;       ///< for each triangle the input triangle that it lies in; none for one that was added
  std::string note; ///< what was mended, in words; empty when nothing was
};

/// The surface with vertices of equal position merged, and `mend` applied. Positions must be finite.
Repaired repaired(const TriMesh& mesh);

/// Drops triangles whose corners lie on one line (flipping the edge that the middle corner lies on) and all but the
/// first of triangles with the same corners; orients each closed manifold shell consistently. A shell that was
/// oriented consistently keeps its orientation; a scrambled one comes out facing outwards. No point of the surface
/// moves. O(n log n).
void mend(Repaired& surface);

/// Closes every hole: the loop of border edges around it is spanned by the triangles of least total area (Barequet
/// and Sharir, Filling gaps in the boundary of a polyhedron, 1995; loops of more than 500 edges by a fan around their
/// centre). Borders that form no loop stay open. Returns how many holes were closed; `widest` is raised to the
/// diagonal of the largest one's box.
std::size_t close_holes(Repaired& surface, double& widest);

/// Cuts out the triangles that meet others where they must not, stand at non-manifold or misoriented edges or have no
/// area, with a margin that grows from round to round, and closes the holes that this leaves, until the surface is
/// clean. Does so only where few triangles are at fault and no two large shells run through one another: cutting
/// would part them with a gap. Returns how many were cut out; 0, with the surface as it was, when the surface cannot
/// be mended so.
std::size_t cut_out_faults(Repaired& surface);

/// Whether TetGen can take the surface. Shells that are inside out do not matter here: they are turned on the way.
bool can_be_filled(SurfaceDefects defects);

/// Vertices that no triangle uses go; the others keep their order.
void drop_unused_vertices(TriMesh& mesh);

/// Gives the triangles that were added numbers after the input's and appends them to it: `source` names triangles of
/// `original` throughout.
void append_added(Repaired& surface, TriMesh& original);

/// Splits edges longer than `longest` (mm) at their middle, again and again, without moving the surface. Throws
/// InvalidInput, naming `name`, when that would make more than 30 million triangles.
void split_long_edges(Repaired& surface, double longest, const std::string& name);

} // namespace pith::surface
