#pragma once
// Cuts and moves of a recipe, done: the one way for a build, the command line and a window.
#include "recipe/recipe.h"
#include "volume/cut/cut.h"
#include "volume/mesh/locate.h"

namespace pith {

/// Does one cut. `where` names the step in messages ("kiwi.json: /cuts/0"). The pieces stay unchanged when it throws.
/// Errors: InvalidInput when the shape is degenerate, meets no piece, names a place outside all pieces, or when
/// nothing would be left.
CutResult apply_cut(Pieces& pieces, const TetMesh& root, const Boundary& boundary, const Locator& locator,
                    const CutStep& step, const std::string& where);

/// Moves one piece. Errors: InvalidInput when `piece` lies in no piece.
void apply_move(Pieces& pieces, const TetMesh& root, const Locator& locator, const MoveStep& step,
                const std::string& where);

/// The piece that holds a rest point; InvalidInput, naming `where`, when none does.
std::uint32_t piece_named(const Pieces& pieces, const TetMesh& root, const Locator& locator, const Vec3d& point,
                          const std::string& where);

/// A rest point well inside a piece, to name it by.
Vec3d rest_point_in(const Pieces& pieces, std::uint32_t piece, const TetMesh& root);

/// Appends a cut to the recipe of a finished model. Where pieces were moved, the cut remembers where all of them
/// stood and the moves, which it has taken in, leave the list.
void append_cut(Recipe& recipe, CutStep step, const Pieces& pieces_before, const TetMesh& root);

} // namespace pith
