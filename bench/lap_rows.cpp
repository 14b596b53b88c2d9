// lap/*: fields and fill of a recipe's solids, their tets given.
#include "bench/fixtures.h"
#include "volume/base/parallel.h"

#include <fmt/format.h>
#include <fstream>

namespace pith::bench {
namespace {

/// Seconds of all stages that stand between tets and finished layers, and what they made.
struct Filling {
  double seconds = 0;
  std::size_t tets = 0, pastes = 0, lookups = 0;
};

Filling filling_of(const BuildResult& result) {
  Filling filling;
  for (const StageReport& stage : result.stages)
    for (const char* name : {"depth ", "along ", "around ", "frames ", "fill "})
      if (stage.name.starts_with(name)) filling.seconds += stage.seconds;
  filling.tets = result.model.mesh.tet_count();
  for (const FillReport& fill : result.fills) {
    filling.pastes += fill.statistics.pastes;
    filling.lookups += fill.statistics.lookups;
  }
  return filling;
}

std::string described(const Filling& filling) {
  return fmt::format("{} tets, {} pastes, {:.1f} look-ups per tet", filling.tets, filling.pastes,
                     double(filling.lookups) / double(filling.tets));
}

/// `paper`: what Takayama et al. took (Table 1), seconds, for the fill alone.
Measured table1(const Settings& settings, const std::string& name, double paper) {
  Filling filling;
  const auto median_with = [&](int threads) {
    const ThreadLimit limit(threads);
    std::vector<double> seconds;
    for (int i = settings.times(3); i > 0; --i) {
      filling = filling_of(built_recipe(settings, "table1/" + name + ".json").result);
      seconds.push_back(filling.seconds);
    }
    return median(seconds);
  };
  const double one = median_with(1), two = median_with(2);
  return {two, fmt::format("{}; 1 thread {:.3f} s, 2 threads {:.3f} s (× {:.2f}); the paper's {:g} s",
                           described(filling), one, two, one / two, paper)};
}

void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5"; }

/// The most memory that this process has held since then, GB; 0 where the system does not say.
double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) * 1e-6;
  return 0;
}

/// A kiwi, its exemplar of 128³ spanning the depth, in tets of the given edge, without its seeds.
Measured large(const Settings& settings, double edge) {
  reset_peak_memory();
  const BuiltRecipe built = built_recipe(settings, "kiwi.json", [&](Recipe& recipe) {
    recipe.tetrahedralize.interior_edge = edge;
    for (Solid& solid : recipe.solids) solid.scatter.clear();
  });
  const Filling filling = filling_of(built.result);
  return {filling.seconds,
          fmt::format("{}; {:.2f} GB at most, tets being made included", described(filling), peak_memory())};
}

} // namespace

std::vector<Row> lap_rows() {
  const auto row = [](const char* name, const char* target, double paper) {
    return Row{std::string("lap/") + name, "s", target,
               [name, paper](const Settings& settings) { return table1(settings, name, paper); }};
  };
  return {row("kiwi", "≤ 0.3", 39),
          row("carrot", "sum ≤ 3", 31),
          row("tree", "sum ≤ 3", 104),
          row("watermelon", "sum ≤ 3", 25),
          row("tube", "sum ≤ 3", 18),
          row("strata", "sum ≤ 3", 77),
          row("cake", "≤ 1", 416),
          {"lap/100k", "s", "", [](const Settings& settings) { return large(settings, 3); }},
          {"lap/1m", "s", "≤ 60, ≤ 4 GB", [](const Settings& settings) { return large(settings, 1.085); }}};
}

} // namespace pith::bench
