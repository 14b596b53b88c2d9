#pragma once
// The paths in a recipe.
#include "recipe/recipe.h"

#include <functional>

namespace pith {

/// Calls `visit` for every path that is not empty.
void for_each_path(Recipe& recipe, const std::function<void(std::string&)>& visit);

/// The same recipe when it lies in another folder: relative paths are changed so that they name the same files.
Recipe rebased(Recipe recipe, const std::filesystem::path& from, const std::filesystem::path& to);

} // namespace pith
