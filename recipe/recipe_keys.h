#pragma once
// The keys of all stages of a recipe, in the order of the chain (build.h): each made of the stage's options, the
// content of the files that it reads, and the keys of the stages that it stands on.
#include "recipe/stage_run.h"

#include <array>

namespace pith {

/// The keys of one solid's stages.
struct SolidKeys {
  Key depth, along, around, frames, exemplar, fill; ///< of fields that the solid has not: zeros
  std::vector<Key> scatter_thing, scatter, paste_thing, paste;
};

/// The scalar fields of a solid.
struct SolidField {
  const char* name;
  const std::vector<DepthConstraint>* constraints;
  Key SolidKeys::*key;
};
std::array<SolidField, 3> fields_of(const Solid& solid);

struct RecipeKeys {
  Key surface, root;
  std::vector<Key> meshed; ///< after meshing, and after each divide
  std::vector<SolidKeys> solid;
  std::map<Key, std::string> thing_name; ///< of the stages that make things
  std::vector<Key> step;                 ///< of cuts, then of moves
};

/// Makes the keys and announces their stages to `run`. Errors: InvalidInput for files that do not exist; IoFailure.
RecipeKeys announced_keys(StageRun& run, const Recipe& recipe, const std::filesystem::path& folder);

/// A stage's name: "cut 1", "paste 0.2".
std::string numbered(const char* stage, std::size_t i);
std::string numbered(const char* stage, std::size_t i, std::size_t k);

/// Strokes inside the solids that mark an innermost place: they should run through vertices.
std::vector<std::vector<Vec3d>> axis_strokes(const Recipe& recipe);
/// The recipe's options of tetrahedralize, with these strokes.
TetrahedralizeOptions meshing_of(const Recipe& recipe);

} // namespace pith
