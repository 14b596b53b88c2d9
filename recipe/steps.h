#pragma once
// Cuts and moves of a recipe, done: the one way for a build, the command line and a window.
#include "recipe/recipe.h"
#include "volume/cut/arrange.h"
#include "volume/layer/model.h"
#include "volume/mesh/locate.h"

namespace pith {

/// What steps work on.
struct StepContext {
  const Model& model;
  const Locator& locator;
  std::filesystem::path folder = {}; ///< what the paths of surfaces are relative to
  Cutter* cutter = nullptr;          ///< of the model; null: every cut passes over all tets
  /// False: halves that do not hang together stay one piece. They look the same, and it saves a pass over all tets: for
  /// a cut that follows the mouse.
  bool separate = true;
};

/// Does one cut, or joins pieces. Halves that do not hang together become pieces of their own. `where` names the step
/// in messages ("kiwi.json: /cuts/0"). The pieces stay unchanged when it throws. Errors: InvalidInput when the shape
/// is degenerate, meets no piece, names a place outside all pieces or a region without depth, or when nothing would
/// be left; IoFailure where a surface cannot be read.
CutResult apply_cut(Pieces& pieces, const StepContext& context, const CutStep& step, const std::string& where);

/// The values of a depth cut, for cut_by_values: depth − value at each vertex id. Vertices of other regions take what
/// is nearest in the region. Errors: InvalidInput when the model has no depth, or no such region.
std::vector<double> depth_values(const Pieces& pieces, const Model& model, const DepthCut& cut,
                                 const std::string& where);

/// Moves one piece, or all. Errors: InvalidInput when `piece` lies in no piece.
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
