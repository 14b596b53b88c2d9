#pragma once
// From a recipe to a model: a chain of pure stages, each remembered under the key of all that it depends on.
//
//   surface → tets → divide 0 → divide 1 → … → refine
//   refine → per solid: depth, along, around → frames ┐
//                                     exemplar ───────┴→ fill
//   frames, things → pastes → scatter 0 → scatter 1 → …
//   refine → cut 0 → cut 1 → … → move 0 → …
//
// A changed stroke re-does only what depends on it; an appended cut runs only that cut.
#include "recipe/cache.h"
#include "recipe/recipe.h"
#include "volume/base/parallel.h"
#include "volume/cut/piece.h"
#include "volume/layer/model.h"

#include <functional>
#include <map>

namespace pith {

struct BuildOptions {
  std::filesystem::path cache;                ///< folder for results; empty: none on disk
  std::uint64_t cache_bytes = 2'000'000'000;  ///< of the folder; least recently used entries leave first
  std::uint64_t memory_bytes = 1'000'000'000; ///< of results kept in memory between builds
  std::string code;                           ///< part of every key; empty: code_version()
};

/// Called as work goes on, with the stage's name; false asks for an end (Cancelled).
using BuildProgress = std::function<bool(const std::string& stage, double fraction)>;

struct StageReport {
  std::string name;    ///< "tets", "fill 0", "cut 1" …
  std::string key;     ///< 32 hexadecimal digits
  double seconds = 0;  ///< spent computing or loading it
  bool cached = false; ///< not computed in this build: found, or not needed because what follows was found
};

struct FillReport {
  std::size_t solid = 0; ///< entry of the recipe's solids
  TextureType type = TextureType::tensor_2b;
  LapStatistics statistics;
  SingularSet singular; ///< where the solid's frames are not determined
};

struct ScatterReport {
  std::size_t solid = 0, entry = 0; ///< of the recipe's solids, and of that solid's scatter
  int placed = 0;                   ///< things that found room
  int wanted = 0;
};

struct BuildResult {
  Model model;
  Pieces pieces;
  std::vector<StageReport> stages; ///< in the order of the chain
  std::vector<FillReport> fills;   ///< one per lapped solid
  std::vector<ScatterReport> scatters;
  std::string note; ///< what the user should know (a fall-back taken); empty otherwise

  std::map<std::string, std::string> keys() const; ///< stage → key, as a .pith file stores them
};

/// After a cut was appended to a recipe (append_cut) and done by hand: brings the keys of a model file up to date, so
/// that they are those of a build of the new recipe by this program.
void add_last_cut(std::map<std::string, std::string>& keys, const Recipe& recipe);
/// The same after a move was appended.
void add_last_move(std::map<std::string, std::string>& keys, const Recipe& recipe);

/// Builds recipes and remembers the results of their stages.
class Builder {
public:
  explicit Builder(BuildOptions options = {});

  /// `folder`: what the recipe's paths are relative to. Errors: what the stages throw, InvalidInput where the recipe
  /// does not fit its inputs (a region that the surface has not, a missing file), Cancelled.
  BuildResult build(const Recipe& recipe, const std::filesystem::path& folder, const BuildProgress& progress = {});

private:
  BuildOptions options_;
  MemoryCache memory_;
  DiskCache disk_;
};

} // namespace pith
