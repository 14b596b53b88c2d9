#pragma once
// The surface that a recipe starts from: a file, or a shape that pith makes itself.
#include "recipe/recipe.h"

namespace pith {

/// What messages call it: the file's name, or the shape's.
std::string surface_name(const SurfaceSource& source);

/// The surface, scaled. `path`: of its file; not looked at for a shape. Errors: those of read_tri_mesh and
/// named_shape.
TriMesh surface_of(const SurfaceSource& source, const std::filesystem::path& path);

} // namespace pith
