#pragma once
// Inside volume/mesh: which side of which shell is material, and the tets' regions from it.
#include "volume/mesh/tet_mesh.h"
#include "volume/mesh/tetrahedralize_repair.h"
#include "volume/mesh/tetrahedralize_shells.h"

#include <string>

namespace pith::surface {

/// What the shells of a clean surface mean. A shell that lies in no other bounds material, whichever way it faces.
/// Inside material, a shell that faces the same way as the one around it bounds a region of its own (a stone in
/// flesh); one that faces the other way is a cavity. Inside a cavity every shell bounds material again.
struct Regions {
  PerTriangle<std::uint32_t> shell; ///< of each triangle
  std::vector<std::uint32_t> depth; ///< of each shell: how many others it lies in
  std::vector<std::int32_t> region; ///< of each shell's inside; −1: a cavity
};

/// Turns every shell to face outwards, whether material or cavity, and says what it bounds. Regions are numbered by
/// depth, then by the shell's first triangle. The surface is closed, manifold and consistently oriented. `turned`
/// counts the outermost shells that were inside out.
Regions outward_with_regions(TriMesh& mesh, std::size_t& turned);

/// Sorts out what TetGen made of the surface: tets inside cavities go, regions are numbered, `mesh` is connected.
/// On return input[4·t + i] names the triangle of `surface` that facet i of tet t lies on, where it lies on one.
/// Returns what is wrong when the tets do not fill the surface exactly, or one of them has no volume; empty: all is
/// well.
std::string label_tets(const TriMesh& surface, const Regions& regions, TetMesh& mesh, std::vector<TriangleId>& input);

} // namespace pith::surface
