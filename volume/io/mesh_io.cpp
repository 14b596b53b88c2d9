// Which reader and writer a mesh file gets, and what all of them check.
#include "volume/io/mesh_io.h"

#include "volume/io/mesh_io_formats.h"

#include <cerrno>
#include <fstream>
#include <system_error>
#include <unistd.h>

namespace pith {
namespace {

constexpr const char* use_known = "pith reads and writes .obj, .off, .ply and .stl: convert the file to one of them";

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  return extension;
}

std::string contents_of(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) throw IoFailure(path.string(), "is a folder, not a mesh file");
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) throw IoFailure(path.string(), "cannot be opened: " + std::generic_category().message(errno));
  const std::streamoff size = file.tellg();
  if (size < 0) throw IoFailure(path.string(), "cannot be read to its end");
  std::string contents(static_cast<std::size_t>(size), '\0');
  file.seekg(0);
  file.read(contents.data(), size);
  if (file.gcount() != size) throw IoFailure(path.string(), "cannot be read to its end");
  return contents;
}

} // namespace

TriMesh read_tri_mesh(const std::filesystem::path& path, double scale) {
  const std::string name = path.string(), extension = extension_of(path);
  if (!std::isfinite(scale) || scale <= 0)
    throw InvalidInput(name, "the scale " + std::to_string(scale) + " is not a positive number",
                       "give a scale above 0");
  const bool known = extension == ".obj" || extension == ".off" || extension == ".ply" || extension == ".stl";
  if (!known) throw InvalidInput(name, "there is no reader for '" + extension + "'", use_known);
  const std::string contents = contents_of(path);
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

  // Written beside, then renamed: the file appears whole or not at all.
  std::filesystem::path beside = path;
  beside += ".part" + std::to_string(::getpid());
  std::error_code ignored;
  {
    std::ofstream file(beside, std::ios::binary | std::ios::trunc);
    if (!file) throw IoFailure(path.string(), "cannot be written: " + std::generic_category().message(errno));
    file.write(contents.data(), static_cast<std::streamsize>(contents.size()));
    file.close();
    if (!file) {
      std::filesystem::remove(beside, ignored);
      throw IoFailure(path.string(), "cannot be written whole: is the disk full?");
    }
  }
  std::error_code error;
  std::filesystem::rename(beside, path, error);
  if (error) {
    std::filesystem::remove(beside, ignored);
    throw IoFailure(path.string(), "cannot be written: " + error.message());
  }
}

} // namespace pith
