// OBJ (Wavefront): positions, polygons, groups and materials; texture coordinates, normals and curves are skipped.
#include "volume/io/mesh_io_formats.h"

#include <map>

namespace pith::mesh_format {

TriMesh read_obj(std::string_view text, const std::string& name) {
  refuse_binary(text, name, "an OBJ file");
  TextCursor cursor(without_byte_order_mark(text), name);
  TriMesh mesh;
  std::vector<VertexId> polygon;
  std::int64_t largest = 0;         // the largest vertex number named so far, from 1
  std::size_t largest_line = 0;     // ... and where: vertices may follow the faces that name them
  std::array<std::string, 3> group; // object, group, material
  std::map<std::array<std::string, 3>, std::int32_t> parts;

  const auto read_face = [&] {
    polygon.clear();
    for (;;) {
      cursor.skip_spaces();
      if (cursor.at_line_end()) break;
      const std::int64_t written = cursor.integer("a corner of the face");
      const auto known = static_cast<std::int64_t>(mesh.vertex_count());
      const std::int64_t number = written < 0 ? known + 1 + written : written;
      if (number < 1 || number >= 0xffffffff)
        cursor.fail("a face names vertex " + std::to_string(written) + "; " + std::to_string(known) +
                        " vertices are known here",
                    "numbers start at 1, or count backwards from −1");
      if (number > largest) {
        largest = number;
        largest_line = cursor.line();
      }
      polygon.push_back(VertexId(number - 1));
      if (!cursor.at_line_end() && !cursor.at_space() && !cursor.at('/'))
        cursor.fail("there is no whole number where a corner of the face belongs");
      cursor.skip_attached(); // "/texture/normal"
    }
    if (polygon.size() < 3) cursor.fail("a face has " + std::to_string(polygon.size()) + " corners");
    add_fan(mesh, polygon);
    const std::int32_t part = parts.try_emplace(group, static_cast<std::int32_t>(parts.size())).first->second;
    mesh.part.resize(mesh.corner.size(), part);
  };

  for (cursor.skip_blank(); !cursor.at_end(); cursor.skip_line(), cursor.skip_blank()) {
    const std::string_view keyword = cursor.word();
    if (keyword == "v") {
      const double x = cursor.number("x"), y = cursor.number("y"), z = cursor.number("z");
      mesh.position.push_back({x, y, z});
    } else if (keyword == "f" || keyword == "fo") {
      read_face();
    } else if (keyword == "o") {
      group = {std::string(cursor.rest_of_line()), "", group[2]};
    } else if (keyword == "g") {
      group[1] = cursor.rest_of_line();
    } else if (keyword == "usemtl") {
      group[2] = cursor.rest_of_line();
    }
  }
  if (largest > static_cast<std::int64_t>(mesh.vertex_count()))
    throw InvalidInput(name + ", line " + std::to_string(largest_line),
                       "a face names vertex " + std::to_string(largest) + " of " +
                           std::to_string(mesh.vertex_count()),
                       "the file is damaged or cut short: export the mesh again");
  return mesh;
}

} // namespace pith::mesh_format
