#include "recipe/recipe_paths.h"

namespace pith {
namespace fs = std::filesystem;

void for_each_path(Recipe& recipe, const std::function<void(std::string&)>& visit) {
  const auto see = [&](std::string& path) {
    if (!path.empty()) visit(path);
  };
  see(recipe.surface.file);
  for (DivideStep& divide : recipe.divides)
    if (divide.surface) see(divide.surface->file);
  for (Solid& solid : recipe.solids) {
    see(solid.exemplar.file);
    for (ScatterStep& scatter : solid.scatter) see(scatter.thing.exemplar.file);
    for (PasteStep& paste : solid.pastes) see(paste.thing.exemplar.file);
  }
  for (CutStep& cut : recipe.cuts)
    if (cut.surface) see(cut.surface->file);
  see(recipe.scene);
}

Recipe rebased(Recipe recipe, const fs::path& from, const fs::path& to) {
  const fs::path old_folder = fs::weakly_canonical(from), new_folder = fs::weakly_canonical(to);
  if (old_folder == new_folder) return recipe;
  for_each_path(recipe, [&](std::string& path) {
    if (fs::path(path).is_relative())
      path = (old_folder / path).lexically_normal().lexically_relative(new_folder).string();
  });
  return recipe;
}

} // namespace pith
