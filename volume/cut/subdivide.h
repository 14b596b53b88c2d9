#pragma once
// The second half of a cut: new vertices, the halves' tets and the tags of their faces. Not part of the public face
// of this module.
#include "volume/cut/classify.h"
#include "volume/cut/level_set.h"

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

struct GroupField {
  std::span<const double> value;       ///< by vertex id
  const LevelSet* level_set = nullptr; ///< null: the values' linear interpolation is the field
  double snap = 0;                     ///< new vertices keep this fraction from the ends of their edges
};

/// `first_added`: id of the first vertex that this cut adds.
GroupCut subdivided(const Pieces& pieces, const TetMesh& root, const Boundary& boundary, const PieceGroup& group,
                    const Sides& sides, const GroupField& field, VertexId first_added);

} // namespace pith
