#pragma once
// The second half of a cut: new vertices, the halves' tets and the tags of their faces. Not part of the public face
// of this module.
#include "volume/cut/classify.h"

namespace pith {

/// What the cut of one group of pieces makes; nothing of the pieces has changed yet.
struct GroupCut {
  std::vector<std::uint32_t> piece;              ///< that fall in two, ascending
  std::vector<std::vector<CutTet>> below, above; ///< their cut tets, by row of `piece`
  std::vector<TetId> opened;                     ///< root tets that no piece keeps whole any more
  std::vector<AddedVertex> added;
  std::vector<Vec3d> added_position;
  std::vector<Vec3f> added_normal;
  std::vector<SectionNormal> on_section; ///< ascending by vertex
  std::size_t tets_cut = 0;
};

/// `first_added`: id of the first vertex that this cut adds. New vertices lie at the field's zeros, but keep the snap
/// from the ends of their edges; where rounding would leave a tet without volume (tiny tets that many cuts have
/// made), they move along their edge until all volumes are positive, by the exact predicate. Throws SolverFailure
/// when none are.
GroupCut subdivided(const Pieces& pieces, const TetMesh& root, const Boundary& boundary, const PieceGroup& group,
                    const Sides& sides, const GroupField& field, VertexId first_added);

} // namespace pith
