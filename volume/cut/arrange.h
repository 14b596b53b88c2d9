#pragma once
// What is done with pieces besides cutting them: keep some, part those that do not hang together, join, move apart.
#include "volume/cut/cut.h"

namespace pith {

/// Keeps the given pieces only, in that order; added vertices that nothing uses are dropped. Root tets of the others
/// keep the label `was_cut`. Throws InvalidInput when `keep` is empty, names a piece twice or one that does not
/// exist.
void keep_pieces(Pieces& pieces, const TetMesh& root, std::span<const std::uint32_t> keep);

/// Moves left halves and right halves of a fresh cut apart by `distance` mm (half each) along the mean section
/// normal. Throws InvalidInput when the section is closed, so that no mean normal exists, or nothing was cut.
void spread(Pieces& pieces, const CutResult& result, const TetMesh& root, double distance);

/// Halves of a fresh cut that do not hang together by faces become pieces of their own: the part with the lowest root
/// tet keeps the number, the others are appended, by piece and then by their lowest root tet; `result.origin` grows
/// with them. O(tets).
void separate_pieces(Pieces& pieces, const TetMesh& root, CutResult& result);

/// Makes one piece of several: it stands where the first that is named stood and takes the lowest of their numbers;
/// those above close up. Faces where they meet are inner faces again; the tets that cuts have made stay, so the set
/// of points is what it was before the cuts. Returns, for each piece that is left, its number before. Throws
/// InvalidInput
/// (`where`) when fewer than two are named, one does not exist, or a piece shares no section with the others.
std::vector<std::uint32_t> join_pieces(Pieces& pieces, std::span<const std::uint32_t> named,
                                       const std::string& where = "join");

/// Moves every piece away from the middle of all (weighted by volume) by `part` of its distance from it; negative:
/// towards it.
void explode(Pieces& pieces, const TetMesh& root, double part);

/// Moves every piece along z until its lowest point is on the plane z = `height`.
void drop(Pieces& pieces, const TetMesh& root, double height);

} // namespace pith
