// OFF (Geomview's object file format, text): counts, vertices, polygons; colours and normals are skipped.
#include "volume/io/mesh_io_formats.h"

namespace pith::mesh_format {

TriMesh read_off(std::string_view text, const std::string& name) {
  TextCursor cursor(text, name);
  cursor.skip_blank();
  std::string_view magic = cursor.word();
  if (magic.substr(0, 2) == "ST") magic.remove_prefix(2);
  if (magic.substr(0, 1) == "C") magic.remove_prefix(1);
  if (magic.substr(0, 1) == "N") magic.remove_prefix(1);
  if (magic != "OFF") cursor.fail("it does not begin with OFF", "this is not a text OFF file: check its extension");
  cursor.skip_blank();

  const std::int64_t vertices = cursor.integer("the count of vertices");
  const std::int64_t faces = cursor.integer("the count of faces");
  cursor.skip_line();
  // A vertex takes at least six bytes, a face at least two: no count can make us reserve more than the file's size.
  if (vertices < 0 || faces < 0 || static_cast<std::uint64_t>(vertices) > text.size() ||
      static_cast<std::uint64_t>(faces) > text.size())
    cursor.fail("it announces " + std::to_string(vertices) + " vertices and " + std::to_string(faces) +
                " faces, more than a file of " + std::to_string(text.size()) + " bytes can hold");

  TriMesh mesh;
  mesh.position.reserve(static_cast<std::size_t>(vertices));
  mesh.corner.reserve(static_cast<std::size_t>(faces));
  for (std::int64_t v = 0; v < vertices; ++v) {
    cursor.skip_blank();
    if (cursor.at_end())
      cursor.fail("the file ends after " + std::to_string(v) + " of " + std::to_string(vertices) + " vertices");
    const double x = cursor.number("x"), y = cursor.number("y"), z = cursor.number("z");
    mesh.position.push_back({x, y, z});
    cursor.skip_line();
  }
  std::vector<VertexId> polygon;
  for (std::int64_t f = 0; f < faces; ++f) {
    cursor.skip_blank();
    if (cursor.at_end())
      cursor.fail("the file ends after " + std::to_string(f) + " of " + std::to_string(faces) + " faces");
    const std::int64_t corners = cursor.integer("the count of corners");
    if (corners < 0 || corners > vertices)
      cursor.fail("a face has " + std::to_string(corners) + " corners among " + std::to_string(vertices) +
                  " vertices");
    polygon.clear();
    for (std::int64_t i = 0; i < corners; ++i) {
      const std::int64_t v = cursor.integer("a corner");
      if (v < 0 || v >= vertices)
        cursor.fail("a face names vertex " + std::to_string(v) + " of " + std::to_string(vertices));
      polygon.push_back(VertexId(v));
    }
    add_fan(mesh, polygon);
    cursor.skip_line();
  }
  return mesh;
}

} // namespace pith::mesh_format
