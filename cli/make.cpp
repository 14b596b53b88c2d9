// pith make RECIPE.json -o MODEL.pith
#include "cli/command.h"
#include "recipe/build.h"
#include "volume/io/atomic_file.h"
#include "volume/io/model_io.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

namespace pith::cli {
namespace {

struct MakeOptions {
  std::filesystem::path recipe, output, cache;
  bool no_cache = false;
  double cache_gigabytes = 2;
};

Json stage_list(const std::vector<StageReport>& stages) {
  Json list = Json::array();
  for (const StageReport& stage : stages)
    list.push_back({{"name", stage.name}, {"seconds", stage.seconds}, {"cached", stage.cached}, {"key", stage.key}});
  return list;
}

Json fill_list(const std::vector<FillReport>& fills) {
  Json list = Json::array();
  for (const FillReport& fill : fills)
    list.push_back({{"solid", fill.solid},
                    {"type", traits_of(fill.type).name},
                    {"pastes", fill.statistics.pastes},
                    {"rounds", fill.statistics.rounds},
                    {"lookups", fill.statistics.lookups},
                    {"inverted_lookups", fill.statistics.inverted},
                    {"median_share_used", fill.statistics.median_share_used},
                    {"singular_tets", fill.singular.tets},
                    {"singular_share", fill.singular.share}});
  return list;
}

Json scatter_list(const std::vector<ScatterReport>& scatters) {
  Json list = Json::array();
  for (const ScatterReport& scatter : scatters)
    list.push_back(
        {{"solid", scatter.solid}, {"entry", scatter.entry}, {"placed", scatter.placed}, {"wanted", scatter.wanted}});
  return list;
}

void run(const MakeOptions& options, const Session& session) {
  const auto start = std::chrono::steady_clock::now();
  check_output(options.output, {"pith"});
  Recipe recipe = read_recipe(options.recipe);
  if (session.seed)
    for (Solid& solid : recipe.solids) {
      solid.fill.seed = *session.seed;
      for (ScatterStep& scatter : solid.scatter) scatter.options.seed = *session.seed;
    }

  BuildOptions build;
  build.cache_bytes = static_cast<std::uint64_t>(options.cache_gigabytes * 1e9);
  if (!options.no_cache) build.cache = options.cache.empty() ? default_cache_folder() : options.cache;
  Builder builder(build);
  const BuildResult result =
      builder.build(recipe, options.recipe.parent_path(),
                    [&](const std::string& stage, double fraction) { return session.progress(stage)(fraction); });
  session.stop_if_asked();
  write_model(options.output, result.model, result.pieces, recipe_text(recipe), result.keys());

  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::size_t lookups = 0, patches = 0;
  for (const Layer& layer : result.model.layer) lookups += layer.lookup.size(), patches += layer.patch.size();
  for (const StageReport& stage : result.stages)
    session.say(fmt::format("{:12} {:9.3f} s{}", stage.name, stage.seconds, stage.cached ? "  (remembered)" : ""));
  for (const FillReport& fill : result.fills)
    session.say(fmt::format(
        "solid {}: type {}, {} pastes, {:.2f} % of the look-ups in mirror image; no determined direction "
        "in {} tets, {:.2f} % of the volume",
        fill.solid, traits_of(fill.type).name, fill.statistics.pastes,
        100.0 * double(fill.statistics.inverted) / double(std::max<std::size_t>(1, fill.statistics.lookups)),
        fill.singular.tets, 100 * fill.singular.share));
  if (!result.note.empty()) session.say("note: " + result.note);
  for (const ScatterReport& scatter : result.scatters)
    if (scatter.placed < scatter.wanted)
      session.say(fmt::format("note: /solids/{}/scatter/{}: {} of {} things found room", scatter.solid, scatter.entry,
                              scatter.placed, scatter.wanted));
  session.say(
      fmt::format("{}: {} tets, {} boundary facets, {} pastes, {} look-ups, {} piece(s); {:.2f} s, {:.0f} MB at most",
                  options.output.string(), result.model.mesh.tet_count(), result.model.boundary.facet_count(),
                  patches, lookups, result.pieces.piece.size(), seconds, peak_memory_bytes() / 1e6));
  session.print({{"model", options.output.string()},
                 {"name", recipe.name},
                 {"seconds", seconds},
                 {"stages", stage_list(result.stages)},
                 {"fills", fill_list(result.fills)},
                 {"scatters", scatter_list(result.scatters)},
                 {"peak_memory_bytes", peak_memory_bytes()},
                 {"helper_peak_memory_bytes", helper_peak_memory_bytes()},
                 {"vertices", result.model.mesh.vertex_count()},
                 {"tets", result.model.mesh.tet_count()},
                 {"facets", result.model.boundary.facet_count()},
                 {"patches", patches},
                 {"lookups", lookups},
                 {"pieces", result.pieces.piece.size()},
                 {"note", result.note}});
}

} // namespace

Verb make_verb(CLI::App& program) {
  auto options = std::make_shared<MakeOptions>();
  CLI::App* app = program.add_subcommand("make", "build a model from a recipe; stages done before are remembered");
  app->add_option("recipe", options->recipe, "the recipe, RECIPE.json")->required();
  app->add_option("-o,--output", options->output, "the model to write, MODEL.pith")->required();
  app->add_option("--cache", options->cache, "folder for results of stages (default: XDG_CACHE_HOME/pith)");
  app->add_option("--cache-gigabytes", options->cache_gigabytes, "most that the folder may hold")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  app->add_flag("--no-cache", options->no_cache, "neither read nor write remembered results");
  return {app, [options](const Session& session) { run(*options, session); }};
}

} // namespace pith::cli
