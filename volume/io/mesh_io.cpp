// Which reader and writer a mesh file gets, and what all of them check.
#include "volume/io/mesh_io.h"

#include "volume/io/atomic_file.h"
#include "volume/io/mesh_io_formats.h"
#include "volume/mesh/surface_size.h"

#include <cmath>

namespace pith {
namespace {

constexpr const char* use_known = "pith reads and writes .obj, .off, .ply and .stl: convert the file to one of them";

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  return extension;
}

} // namespace

TriMesh read_tri_mesh(const std::filesystem::path& path, double scale) {
  const std::string name = path.string(), extension = extension_of(path);
  if (!std::isfinite(scale) || scale <= 0)
    throw InvalidInput(name, "the scale " + std::to_string(scale) + " is not a positive number",
                       "give a scale above 0");
  const bool known = extension == ".obj" || extension == ".off" || extension == ".ply" || extension == ".stl";
  if (!known) throw InvalidInput(name, "there is no reader for '" + extension + "'", use_known);
  const std::string contents = file_content(path);
  if (contents.empty()) throw InvalidInput(name, "the file is empty", "export the mesh again");

  TriMesh mesh = extension == ".obj"   ? mesh_format::read_obj(contents, name)
                 : extension == ".off" ? mesh_format::read_off(contents, name)
                 : extension == ".ply" ? mesh_format::read_ply(contents, name)
                                       : mesh_format::read_stl(contents, name);
  if (mesh.corner.empty())
    throw InvalidInput(name, "it holds " + std::to_string(mesh.vertex_count()) + " vertices but no triangles",
                       "export a surface, not points or curves");
  if (scale != 1)
    for (const VertexId v : all_ids<VertexId>(mesh.vertex_count())) {
      mesh.position[v] *= scale;
      if (!mesh.position[v].allFinite())
        throw InvalidInput(name, "vertex " + std::to_string(v) + " is not finite once scaled",
                           "choose another scale");
    }
  require_usable_size(mesh, name);
  return mesh;
}

void write_tri_mesh(const std::filesystem::path& path, const TriMesh& mesh) {
  const std::string extension = extension_of(path);
  std::string contents;
  if (extension == ".obj")
    contents = mesh_format::obj_text(mesh);
  else if (extension == ".off")
    contents = mesh_format::off_text(mesh);
  else if (extension == ".ply")
    contents = mesh_format::ply_bytes(mesh);
  else if (extension == ".stl")
    contents = mesh_format::stl_bytes(mesh);
  else
    throw InvalidInput(path.string(), "there is no writer for '" + extension + "'", use_known);

  write_file(path, contents);
}

} // namespace pith
