// cut/*: a level set's values given, until both halves are there.
#include "bench/fixtures.h"
#include "volume/cut/cut.h"

#include <fmt/format.h>
#include <variant>

namespace pith::bench {
namespace {

/// The first stroke of a recipe; where it has none, a wavy one across its picture.
StrokeCut stroke_of(const BuiltRecipe& built) {
  for (const CutStep& step : built.recipe.cuts)
    if (const auto* stroke = std::get_if<StrokeCut>(&step.shape)) return *stroke;
  const Box box = bounds_of(built.result.model.mesh);
  StrokeCut stroke;
  stroke.view = {.eye = box.center() + Vec3d(0, 0, 3 * box.diagonal()), .target = box.center()};
  for (int i = -10; i <= 10; ++i) stroke.point.push_back({0.1 * i, 0.02 * std::sin(0.5 * i)});
  return stroke;
}

Measured kiwi(const Settings& settings) {
  const BuiltRecipe built = built_recipe(settings, "table1/kiwi.json");
  const TetMesh& root = built.result.model.mesh;
  const Boundary& boundary = built.result.model.boundary;
  const auto field = level_set_of(stroke_of(built));
  std::vector<double> value(root.vertex_count());
  field->values({root.position.data(), root.position.size()}, value);

  const Pieces whole = whole_piece(root);
  Pieces pieces;
  Cutter cutter(root, boundary);
  std::size_t triangles = 0, tets_cut = 0;
  double cut_alone = 0;
  const int times = settings.times(101);
  const auto both = [&](bool surfaces) {
    return median_seconds(
        times, [&] { pieces = whole; },
        [&] {
          tets_cut = cutter.cut_by_values(pieces, value, field.get()).tets_cut;
          if (!surfaces) return;
          triangles = 0;
          for (std::uint32_t p = 0; p < pieces.piece.size(); ++p)
            triangles += surface_of(pieces, p, root, boundary).triangle.size();
        });
  };
  cut_alone = both(false);
  const double drawn = both(true);
  return {1e3 * drawn,
          fmt::format("{} tets, {} cut; the pieces {:.3f} ms, with their surfaces ({} triangles) {:.3f} ms",
                      root.tet_count(), tets_cut, 1e3 * cut_alone, triangles, 1e3 * drawn)};
}

Measured sphere_1m(const Settings& settings) {
  constexpr int cells = 55;
  const TetMesh root = jittered_cube(cells);
  const Boundary boundary = boundary_of(root);
  const auto field = level_set_of(SphereCut{.center = Vec3d::Constant(0.5 * cells), .radius = 0.3 * cells});
  std::vector<double> value(root.vertex_count());
  field->values({root.position.data(), root.position.size()}, value);
  const Pieces whole = whole_piece(root);
  Pieces pieces;
  Cutter cutter(root, boundary);
  std::size_t tets_cut = 0;
  const auto time_with = [&](int threads) {
    const ThreadLimit limit(threads);
    return median_seconds(
        settings.times(21), [&] { pieces = whole; },
        [&] { tets_cut = cutter.cut_by_values(pieces, value, field.get()).tets_cut; });
  };
  const double all = time_with(0), one = time_with(1);
  return {1e3 * all, fmt::format("{} tets, {} cut; 1 thread {:.2f} ms", root.tet_count(), tets_cut, 1e3 * one)};
}

} // namespace

std::vector<Row> cut_rows() {
  return {{"cut/kiwi", "ms", "≤ 0.2", kiwi}, {"cut/sphere_1m", "ms", "≤ 12", sphere_1m}};
}

} // namespace pith::bench
