#pragma once
// The first half of a cut: on which side every tet of the pieces that stand together lies. Not part of the public
// face of this module.
#include "volume/cut/clusters.h"
#include "volume/cut/patterns.h"
#include "volume/cut/piece.h"

#include <cmath>
#include <span>

namespace pith {

/// Pieces of one placement: they see the same values at shared vertices.
struct PieceGroup {
  Rigid placement;
  std::vector<std::uint32_t> piece; ///< ascending
  bool everything = false;          ///< look at every root tet; all that are whole belong to the group
  std::vector<TetId> whole;         ///< otherwise: the whole root tets to look at, ascending

  // What the level set passes at a distance; empty where all tets are looked at.
  const TetClusters* clusters = nullptr;
  std::vector<std::int8_t> cluster_side; ///< by cluster: −1 or 1; 0: its tets are looked at
  std::vector<std::uint8_t> seen_far;    ///< by piece number, as Sides::seen: of whole tets in clusters of one side
  std::vector<TetId> far_above;          ///< whole tets in clusters of side 1

  /// Where a whole tet that is looked at stands in Sides::whole.
  std::size_t row_of(TetId tet) const;

  /// −1 or 1 for a tet inside a root tet that the level set does not come near, else 0.
  int far_side(TetId root) const { return clusters ? cluster_side[clusters->cluster[root]] : 0; }
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
  std::vector<TetReference> touching;         ///< other tets with a corner on; the same order
  std::vector<std::uint8_t> seen;             ///< by piece number: bit 0 below, bit 1 above; for the group's pieces
  std::vector<std::array<std::uint32_t, 2>> count; ///< by piece number: tets with something below, above; near ones

  int pattern_code(const std::array<VertexId, 4>& corner) const {
    return state[corner[0]] + 3 * state[corner[1]] + 9 * state[corner[2]] + 27 * state[corner[3]];
  }
};

/// The field of a cut at the vertices of one group.
struct GroupField {
  std::span<const double> value; ///< by vertex id
  /// The vertices where it was evaluated: those of all tets that are looked at. Where the group looks at everything:
  /// not read, all vertices are.
  std::span<const VertexId> vertex;
  const LevelSet* level_set = nullptr; ///< null: the values' linear interpolation is the field
  double snap = 0;                     ///< fraction of an edge
  double snap_distance = 0;            ///< and in the values' unit

  /// The fraction of an edge that its new vertex keeps from the ends, by their values. A vertex of value 0 that does
  /// not count as on was put beside the zero set (part_pinches): by more, so that cuts of such cuts keep their
  /// volumes.
  double distance_kept(double a, double b) const {
    constexpr double least = 1e-6, beside_zero = 0.01;
    const double rise = std::abs(a) + std::abs(b);
    const double wanted = a == 0 || b == 0 ? std::max(snap, beside_zero) : snap;
    return std::max(wanted * rise > snap_distance ? snap_distance / rise : wanted, least);
  }
};

/// Classifies all tets of the group. A vertex to which a zero on some edge comes closer than the snap counts as on: a
/// set that depends on the values alone, not on the order of tets. Tets with all corners on are filed under
/// `side_on`. `around`: the root's, or null: then a second pass finds the tets at snapped vertices. `state`:
/// memory for Sides::state. Throws InvalidInput where a value is not finite.
Sides sides_of(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, const GroupField& field,
               const VertexTets* around, std::vector<std::uint8_t> state = {});

/// Vertices that count as on can pinch a half: it would hang together there by a vertex or an edge alone. Such
/// vertices are put back on the side of their value (zero: above), and the tets classified again, until the halves of
/// all pieces are manifold. Precondition: the pieces are.
void part_pinches(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, const GroupField& field,
                  Sides& sides);

/// Files the crossed and touching tets anew by `sides.state`. Precondition: no other tets have a corner on.
void refile(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, Sides& sides);

} // namespace pith
