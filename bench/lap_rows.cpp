// lap/*: fields and fill of a recipe's first solid, its tets given.
#include "bench/fixtures.h"
#include "volume/lap/lap.h"

#include <fmt/format.h>

namespace pith::bench {
namespace {

/// All that stands between tets and a finished layer.
LapResult filled(const BuiltRecipe& built) {
  const Solid& solid = built.recipe.solids.at(0);
  const Model& model = built.result.model;
  const Locator locator(model.mesh, model.boundary);
  const DepthField depth =
      depth_field(model.mesh, model.boundary, solid.region, solid.depth, "depth", solid.depth_options);
  const FrameField frames =
      frames_from_depth(model.mesh, locator, solid.region, depth, solid.orientation, "orientation", solid.frame);
  return lap({.mesh = model.mesh,
              .boundary = model.boundary,
              .region = solid.region,
              .axes = frames.axes,
              .scale = frames.scale,
              .coordinate = {{{}, depth.value, {}}},
              .singular = frames.singular},
             model.layer.at(0).exemplar.at(0), solid.fill);
}

Measured table1(const Settings& settings, const std::string& name) {
  const BuiltRecipe built = built_recipe(settings, "table1/" + name + ".json");
  const int times = settings.times(7);
  LapStatistics statistics;
  const auto time_with = [&](int threads) {
    const ThreadLimit limit(threads);
    return median_seconds(times, {}, [&] { statistics = filled(built).statistics; });
  };
  const double all = time_with(0), one = time_with(1), two = time_with(2);
  return {all,
          fmt::format("{} tets, {} pastes, {:.1f} look-ups per tet; 1 thread {:.3f} s, 2 threads {:.3f} s "
                      "(× {:.2f})",
                      built.result.model.mesh.tet_count(), statistics.pastes,
                      double(statistics.lookups) / double(built.result.model.mesh.tet_count()), one, two, one / two)};
}

} // namespace

std::vector<Row> lap_rows() {
  return {{"lap/kiwi", "s", "≤ 0.3", [](const Settings& settings) { return table1(settings, "kiwi"); }}};
}

} // namespace pith::bench
