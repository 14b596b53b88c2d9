#pragma once
// Cutting pieces by a level set: marching tetrahedra on below/on/above signs, both halves at once.
#include "volume/cut/level_set.h"
#include "volume/cut/piece.h"

namespace pith {

struct CutOptions {
  /// Which pieces to cut; empty: all.
  std::vector<std::uint32_t> only;
  /// Values within this fraction of an edge from a vertex are taken as exactly on it (0: only exact zeros).
  double snap = 0.01;
};

struct CutResult {
  /// For each piece after the cut: the piece it came from and its side (−1 left, +1 right, 0 not touched).
  struct Origin {
    std::uint32_t piece;
    int side;
  };
  std::vector<Origin> origin;
  std::size_t tets_cut = 0; ///< tets that the level set passed through
};

/// Cuts every piece p by φ(placement_p · x). A piece that lies on one side keeps its number; one that is cut becomes its
/// left half (same number) and its right half (appended). New vertices are computed once per (edge, cut, placement), so
/// both halves and all later cuts share their bits; the root's colours need no copy.
/// Errors: InvalidInput when φ is not finite at some vertex, or when nothing is cut at all (the pieces stay unchanged).
/// Cost: one φ per vertex of the pieces, plus work in proportion to the tets cut.
CutResult cut(Pieces& pieces, const TetMesh& root, const Boundary& boundary, const LevelSet& level_set,
              const CutOptions& options = {});

/// The same where the values are known already: `value[v]` for every vertex id of `pieces` (root, then added).
CutResult cut_by_values(Pieces& pieces, const TetMesh& root, const Boundary& boundary, std::span<const double> value,
                        const LevelSet* level_set = nullptr, const CutOptions& options = {});

/// Keeps the given pieces only, in that order; added vertices that nothing uses are dropped.
void keep_pieces(Pieces& pieces, const TetMesh& root, std::span<const std::uint32_t> keep);

/// Moves left halves and right halves of a fresh cut apart by `distance` mm along the mean section normal.
void spread(Pieces& pieces, const CutResult& result, const TetMesh& root, double distance);

} // namespace pith
