#pragma once
// The surface that a recipe starts from: a file, or a shape that pith makes itself.
#include "recipe/recipe.h"

namespace pith {

/// What messages call it: the file's name, or the shape's.
std::string surface_name(const SurfaceSource& source);

/// The surface, scaled. Its file counts from `folder`; `where` is the source's place in the recipe. Errors: those of
/// input_path, read_tri_mesh and named_shape.
TriMesh surface_of(const SurfaceSource& source, const std::filesystem::path& folder, const std::string& where);

/// An input file, found from the recipe's folder. InvalidInput, naming `where`, when there is none.
std::filesystem::path input_path(const std::filesystem::path& folder, const std::string& file,
                                 const std::string& where);

} // namespace pith
