#include "recipe/surface_source.h"

#include "volume/exemplar/shapes.h"
#include "volume/io/mesh_io.h"

namespace pith {

std::string surface_name(const SurfaceSource& source) {
  return source.shape.empty() ? std::filesystem::path(source.file).filename().string() : source.shape;
}

TriMesh surface_of(const SurfaceSource& source, const std::filesystem::path& path) {
  if (source.shape.empty()) return read_tri_mesh(path, source.scale);
  TriMesh shape = named_shape(source.shape, source.triangles);
  for (Vec3d& position : shape.position) position *= source.scale;
  return shape;
}

} // namespace pith
