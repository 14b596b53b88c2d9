#pragma once
// The first half of a cut: on which side every tet of the pieces that stand together lies. Not part of the public
// face of this module.
#include "volume/cut/patterns.h"
#include "volume/cut/piece.h"

#include <span>

namespace pith {

/// Pieces of one placement: they see the same values at shared vertices.
struct PieceGroup {
  Rigid placement;
  std::vector<std::uint32_t> piece; ///< ascending
  std::vector<TetId> whole;         ///< root tets that they keep, ascending; not filled when `everything`
  bool everything = false;          ///< the group is all there is: look at every root tet
};

/// One tet of a piece: a root tet kept whole, or one of the piece's cut tets.
struct TetReference {
  std::uint32_t piece;
  std::uint32_t index; ///< root tet, or row of Piece::cut
  bool whole;

  const std::array<VertexId, 4>& corner(const Pieces& pieces, const TetMesh& root) const {
    return whole ? root.corner[TetId(index)] : pieces.piece[piece].cut[index].corner;
  }
};

enum TetSide : std::uint8_t { side_none = 0, side_below = 1, side_above = 2, side_crossed = 3, side_on = 4 };

struct Sides {
  std::vector<std::uint8_t> state;            ///< VertexState by vertex id, after snapping
  std::vector<std::uint8_t> whole;            ///< TetSide, by root tet (everything) or row of PieceGroup::whole
  std::vector<std::vector<std::uint8_t>> cut; ///< TetSide, by row of the group's pieces and of Piece::cut
  std::vector<TetReference> crossed;          ///< cut tets by (piece, row), then root tets, ascending
  std::vector<TetReference> touching; ///< tets of one side with three corners on, or with all four; the same order
  std::vector<std::uint8_t> seen;     ///< by piece number: bit 0 below, bit 1 above; for the group's pieces

  int pattern_code(const std::array<VertexId, 4>& corner) const {
    return state[corner[0]] + 3 * state[corner[1]] + 9 * state[corner[2]] + 27 * state[corner[3]];
  }
};

/// Classifies all tets of the group. A vertex whose value is within `snap` of an edge from zero, on an edge that
/// changes sign, counts as on: a set that depends on the values alone, not on the order of tets. Tets with all
/// corners on are filed under `side_on`. Throws InvalidInput where a value is not finite.
Sides sides_of(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, std::span<const double> value,
               double snap);

} // namespace pith
