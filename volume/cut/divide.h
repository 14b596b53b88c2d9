#pragma once
// Dividing a mesh before anything stands on it: a level set parts regions in two, so that layers that lie on one
// another (strata, a cake) are regions of their own. One conforming mesh comes out, not pieces.
#include "volume/cut/level_set.h"
#include "volume/mesh/boundary.h"

#include <string>
#include <vector>

namespace pith {

struct DivideOptions {
  /// Regions to divide; empty: every region that the level set passes through.
  std::vector<std::int32_t> only;
  /// Inner vertices within this fraction of an edge from the level set move onto it, where their tets stay well
  /// shaped; vertices of the boundary never move. 0 to 0.4; 0: none moves, and tets may become very thin.
  double snap = 0.2;
};

struct DivideResult {
  TetMesh mesh; ///< connected; the vertices of the mesh that was divided first, then those that the level set made
  /// For each facet of boundary_of(mesh) the triangle it came from; none where regions were parted. Empty when none
  /// were given.
  Indexed<FacetId, TriangleId> input;
  struct Split {
    std::int32_t left;  ///< the region that was divided: its left side keeps the number
    std::int32_t right; ///< the new region on its right
  };
  std::vector<Split> split; ///< ascending
  std::size_t tets_cut = 0; ///< that the level set passed through
  std::size_t moved = 0;    ///< vertices that were moved onto the level set
};

/// Parts regions where φ = 0: what lies on the left (φ < 0) keeps its region, what lies on the right becomes a new
/// one. New numbers follow the largest of the mesh, in the order of the regions that are split. Interfaces lie on the
/// level set itself at all vertices, but for boundary vertices closer to it than snap/4 of their shortest edge, which
/// count as on it where they are. Tets of other regions beside a new interface are subdivided with it, so that every
/// facet has at most two tets. Boundary facets are split where the level set crosses them and stay where they are.
///
/// `input`: for each facet of boundary_of(mesh) the triangle it came from, or empty. `where` names the step in
/// messages. Errors: InvalidInput when `only` names a region that the mesh has not or that the level set misses, when
/// no region is divided, φ is not finite at some vertex, or the snap is out of range. Cost: one φ per vertex, one
/// pass over the tets, and work in proportion to the tets cut. Deterministic.
DivideResult divide(const TetMesh& mesh, const Indexed<FacetId, TriangleId>& input, const LevelSet& level_set,
                    const DivideOptions& options = {}, const std::string& where = "divide");

} // namespace pith
