#include "recipe/surface_source.h"

#include "volume/base/error.h"
#include "volume/exemplar/shapes.h"
#include "volume/io/mesh_io.h"

namespace pith {

std::string surface_name(const SurfaceSource& source) {
  return source.shape.empty() ? std::filesystem::path(source.file).filename().string() : source.shape;
}

TriMesh surface_of(const SurfaceSource& source, const std::filesystem::path& folder, const std::string& where) {
  if (source.shape.empty()) return read_tri_mesh(input_path(folder, source.file, where + "/file"), source.scale);
  TriMesh shape = named_shape(source.shape, source.triangles);
  for (Vec3d& position : shape.position) position *= source.scale;
  return shape;
}

std::filesystem::path input_path(const std::filesystem::path& folder, const std::string& file,
                                 const std::string& where) {
  const std::filesystem::path path =
      std::filesystem::path(file).is_absolute() ? std::filesystem::path(file) : folder / file;
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw InvalidInput(where, "\"" + file + "\" does not exist", "paths count from the recipe's folder");
  if (!std::filesystem::is_regular_file(path, error))
    throw InvalidInput(where, "\"" + file + "\" is not a file", "name a file");
  return path;
}

} // namespace pith
