#pragma once
// Models that several rows measure on.
#include "bench/row.h"
#include "recipe/build.h"
#include "volume/layer/model.h"

namespace pith::bench {

/// A recipe of data/recipes, built without its moves, nothing remembered between calls.
struct BuiltRecipe {
  Recipe recipe;
  BuildResult result;
};
/// `edit` changes the recipe before it is built.
BuiltRecipe built_recipe(const Settings& settings, const std::string& name,
                         const std::function<void(Recipe&)>& edit = {});

/// A cube of 6 · cells³ tets with jittered vertices, edges about 1 mm, its corner at the origin. The tets fill it.
TetMesh jittered_cube(int cells);

/// A layer in the shape of a lapped fill over `jittered_cube(cells)`: overlapping masked patches on a lattice, eight
/// look-ups for each tet.
Layer lattice_of_patches(const TetMesh& mesh, int cells, const Exemplar& exemplar);

} // namespace pith::bench
