#include "recipe/steps.h"

#include "recipe/surface_source.h"
#include "volume/base/error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <sstream>

namespace pith {
namespace {

std::string text_of(const Vec3d& x) {
  std::ostringstream text;
  text << "(" << x.x() << ", " << x.y() << ", " << x.z() << ")";
  return text.str();
}

} // namespace

std::uint32_t piece_named(const Pieces& pieces, const TetMesh& root, const Locator& locator, const Vec3d& point,
                          const std::string& where) {
  const Location location = locator.locate(point);
  if (!location.inside)
    throw InvalidInput(where, text_of(point) + " lies outside the solid", "name a piece by a rest point inside it");
  const std::uint32_t piece = piece_at(pieces, root, location.tet, point);
  if (piece >= pieces.piece.size())
    throw InvalidInput(where, text_of(point) + " lies in a part that an earlier cut took away",
                       "name a piece that is still there");
  return piece;
}

Vec3d rest_point_in(const Pieces& pieces, std::uint32_t piece, const TetMesh& root) {
  const auto whole = std::find(pieces.label.begin(), pieces.label.end(), piece);
  if (whole != pieces.label.end()) return barycenter(root, TetId(whole - pieces.label.begin()));
  double largest = -1;
  Vec3d result = Vec3d::Zero();
  for (const CutTet& tet : pieces.piece[piece].cut) {
    const Vec3d &a = pieces.position(root, tet.corner[0]), &b = pieces.position(root, tet.corner[1]),
                &c = pieces.position(root, tet.corner[2]), &d = pieces.position(root, tet.corner[3]);
    const double volume = (b - a).cross(c - a).dot(d - a);
    if (volume > largest) largest = volume, result = 0.25 * (a + b + c + d);
  }
  return result;
}

namespace {

/// Puts the named pieces together where the first of them stands.
CutResult join_named(Pieces& pieces, const StepContext& context, const CutStep& step, const std::string& where) {
  const TetMesh& root = context.model.mesh;
  std::vector<std::uint32_t> named;
  for (std::size_t i = 0; i < step.join.size(); ++i)
    named.push_back(piece_named(pieces, root, context.locator, step.join[i], where + "/join/" + std::to_string(i)));
  const std::vector<std::uint32_t> from = join_pieces(pieces, named, where + "/join");
  CutResult result;
  for (const std::uint32_t p : from) result.origin.push_back({p, 0});
  return result;
}

/// What a step cuts by.
struct Knife {
  std::unique_ptr<LevelSet> level_set;
  std::vector<double> depth; ///< where there is no level set: depth less the step's value, by vertex id
};

Knife knife_of(const Pieces& pieces, const StepContext& context, const CutStep& step, const std::string& where) {
  if (step.depth) return {nullptr, depth_values(pieces, context.model, *step.depth, where + "/depth")};
  if (step.surface)
    return {level_set_of(surface_of(*step.surface, context.folder, where + "/surface"), where + "/surface"), {}};
  return {level_set_of(step.shape, where), {}};
}

CutResult cut_pieces(Pieces& work, const StepContext& context, const Knife& knife, const CutOptions& options,
                     const std::string& where) {
  const Model& model = context.model;
  try {
    Cutter once = Cutter::for_one_cut(model.mesh, model.boundary);
    Cutter& cutter = context.cutter ? *context.cutter : once;
    return knife.level_set ? cutter.cut(work, *knife.level_set, options)
                           : cutter.cut_by_values(work, knife.depth, nullptr, options);
  } catch (const InvalidInput& error) {
    // What is wrong and how to mend it, at the place in the recipe instead of the library's.
    std::string what = error.what();
    if (what.starts_with("cut: ")) what.erase(0, 5);
    const std::size_t mend = what.rfind("; ");
    throw InvalidInput(where, "cannot be made: " + what.substr(0, mend),
                       mend == std::string::npos ? "move the cut so that it passes through the solid"
                                                 : what.substr(mend + 2));
  }
}

/// The knife's value at a point of a piece that it left whole: the sign of all of it.
double value_in(const Pieces& pieces, std::uint32_t piece, const StepContext& context, const Knife& knife) {
  const Vec3d inside = rest_point_in(pieces, piece, context.model.mesh);
  if (knife.level_set) return knife.level_set->value(pieces.piece[piece].placement(inside));
  const Location at = context.locator.locate(inside);
  double result = 0;
  for (int i = 0; i < 4; ++i) result += at.barycentric[i] * knife.depth[context.model.mesh.corner[at.tet][i]];
  return result;
}

} // namespace

CutResult apply_cut(Pieces& pieces, const StepContext& context, const CutStep& step, const std::string& where) {
  const TetMesh& root = context.model.mesh;
  const Locator& locator = context.locator;
  Knife knife;
  if (step.join.empty()) knife = knife_of(pieces, context, step, where);
  Pieces work = pieces;
  for (std::size_t i = 0; i < step.placements.size(); ++i) {
    const PiecePlacement& stood = step.placements[i];
    const std::string at = where + "/placements/" + std::to_string(i) + "/piece";
    work.piece[piece_named(work, root, locator, stood.piece, at)].placement = stood.placement;
  }
  if (!step.join.empty()) {
    const CutResult joined = join_named(work, context, step, where);
    pieces = std::move(work);
    return joined;
  }
  CutOptions options{.only = {}, .snap = step.snap};
  for (std::size_t i = 0; i < step.only.size(); ++i) {
    const std::string at = where + "/only" + (step.only.size() > 1 ? "/" + std::to_string(i) : "");
    const std::uint32_t piece = piece_named(work, root, locator, step.only[i], at);
    if (std::find(options.only.begin(), options.only.end(), piece) == options.only.end())
      options.only.push_back(piece);
  }
  std::sort(options.only.begin(), options.only.end());

  CutResult result = cut_pieces(work, context, knife, options, where);
  if (context.separate) separate_pieces(work, root, result);
  if (step.spread > 0) spread(work, result, root, step.spread);

  if (step.keep != Keep::both) {
    const int kept_side = step.keep == Keep::left ? -1 : 1;
    std::vector<std::uint32_t> keep;
    for (std::uint32_t piece = 0; piece < work.piece.size(); ++piece) {
      const CutResult::Origin& origin = result.origin[piece];
      int side = origin.side;
      const bool in_scope =
          options.only.empty() || std::binary_search(options.only.begin(), options.only.end(), origin.piece);
      // A piece that the cut left whole stands on one side of it.
      if (side == 0 && in_scope) side = value_in(work, piece, context, knife) < 0 ? -1 : 1;
      if (side == 0 || side == kept_side) keep.push_back(piece);
    }
    if (keep.empty()) throw InvalidInput(where, "keeps nothing", "keep the other side");
    CutResult kept{{}, result.tets_cut};
    for (const std::uint32_t piece : keep) kept.origin.push_back(result.origin[piece]);
    keep_pieces(work, root, keep);
    result = std::move(kept);
  }
  pieces = std::move(work);
  return result;
}

void apply_move(Pieces& pieces, const TetMesh& root, const Locator& locator, const MoveStep& step,
                const std::string& where) {
  if (step.explode) return explode(pieces, root, *step.explode);
  if (step.drop) return drop(pieces, root, *step.drop);
  const std::uint32_t piece = piece_named(pieces, root, locator, step.piece, where + "/piece");
  Rigid& placement = pieces.piece[piece].placement;
  if (step.angle != 0) {
    const Vec3d center = step.about ? *step.about : placement(measure(pieces, piece, root).centroid);
    const Mat3d turn = Eigen::AngleAxisd(step.angle, step.axis.normalized()).toRotationMatrix();
    placement.rotation = turn * placement.rotation;
    placement.translation = turn * (placement.translation - center) + center;
  }
  placement.translation += step.translate;
}

void append_cut(Recipe& recipe, CutStep step, const Pieces& pieces_before, const TetMesh& root) {
  if (!recipe.moves.empty() && step.placements.empty()) {
    for (std::uint32_t piece = 0; piece < pieces_before.piece.size(); ++piece)
      step.placements.push_back({rest_point_in(pieces_before, piece, root), pieces_before.piece[piece].placement});
    recipe.moves.clear();
  }
  recipe.cuts.push_back(std::move(step));
}

} // namespace pith
