// STL (stereolithography), text and binary. Normals and attribute bytes are skipped; several solids become parts.
#include "volume/io/mesh_io_formats.h"

namespace pith::mesh_format {
namespace {

constexpr std::size_t header_bytes = 80, facet_bytes = 50;

bool same_word(std::string_view word, std::string_view lower_case) {
  if (word.size() != lower_case.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if ((word[i] | 0x20) != lower_case[i]) return false;
  return true;
}

void add_corner(TriMesh& mesh, const Vec3d& p) {
  mesh.position.push_back(p);
  if (mesh.position.size() % 3 != 0) return;
  const std::size_t last = mesh.position.size() - 1;
  mesh.corner.push_back({VertexId(last - 2), VertexId(last - 1), VertexId(last)});
}

TriMesh read_binary(std::string_view bytes, const std::string& name) {
  const std::uint32_t facets = stored<std::uint32_t>(bytes.data() + header_bytes, false);
  const std::uint64_t needed = header_bytes + 4 + facet_bytes * std::uint64_t(facets);
  if (bytes.size() != needed)
    throw InvalidInput(name,
                       "it announces " + std::to_string(facets) + " triangles, which take " + std::to_string(needed) +
                           " bytes, but has " + std::to_string(bytes.size()),
                       "the file is cut short or no STL: export the mesh again");
  TriMesh mesh;
  mesh.position.reserve(3 * std::size_t(facets));
  mesh.corner.reserve(facets);
  for (std::size_t f = 0; f < facets; ++f) {
    const char* at = bytes.data() + header_bytes + 4 + f * facet_bytes + 12; // after the normal
    for (int corner = 0; corner < 3; ++corner, at += 12) {
      const Vec3d p(stored<float>(at, false), stored<float>(at + 4, false), stored<float>(at + 8, false));
      if (!p.allFinite())
        throw InvalidInput(name + ", byte " + std::to_string(at - bytes.data()),
                           "a corner of triangle " + std::to_string(f) + " is not finite", "export the mesh again");
      add_corner(mesh, p);
    }
  }
  return welded(mesh);
}

TriMesh read_text(std::string_view text, const std::string& name) {
  TextCursor cursor(text, name);
  TriMesh mesh;
  bool inside = false; // between "solid" and "endsolid"
  std::int32_t part = -1;
  const auto next_word = [&] {
    cursor.skip_blank();
    return cursor.word();
  };
  const auto expect = [&](const char* wanted) {
    const std::string_view word = next_word();
    if (same_word(word, wanted)) return;
    if (cursor.at_end() && word.empty()) cursor.fail(std::string("the file ends where '") + wanted + "' belongs");
    cursor.fail(std::string("'") + wanted + "' belongs where other text stands");
  };
  for (;;) {
    const std::string_view word = next_word();
    if (word.empty() && cursor.at_end()) break;
    if (same_word(word, "solid") && !inside) {
      inside = true;
      ++part;
      cursor.skip_line();
    } else if (same_word(word, "endsolid") && inside) {
      inside = false;
      cursor.skip_line();
    } else if (same_word(word, "facet") && inside) {
      cursor.skip_line(); // the normal
      expect("outer");
      expect("loop");
      for (int corner = 0; corner < 3; ++corner) {
        expect("vertex");
        const double x = cursor.number("x"), y = cursor.number("y"), z = cursor.number("z");
        add_corner(mesh, {x, y, z});
      }
      expect("endloop");
      expect("endfacet");
      mesh.part.push_back(part);
    } else {
      cursor.fail(inside ? "'facet' or 'endsolid' belongs here" : "'solid' belongs here");
    }
  }
  if (inside) cursor.fail("the file ends before 'endsolid'");
  return welded(mesh);
}

} // namespace

TriMesh read_stl(std::string_view bytes, const std::string& name) {
  // Binary files too may begin with "solid": their length decides.
  const bool starts_as_text = same_word(bytes.substr(0, 5), "solid");
  const bool has_header = bytes.size() >= header_bytes + 4;
  const bool length_fits =
      has_header &&
      bytes.size() ==
          header_bytes + 4 + facet_bytes * std::uint64_t(stored<std::uint32_t>(bytes.data() + header_bytes, false));
  if (length_fits || (has_header && !starts_as_text)) return read_binary(bytes, name);
  if (starts_as_text) return read_text(bytes, name);
  throw InvalidInput(name, "it has " + std::to_string(bytes.size()) + " bytes and does not begin with 'solid'",
                     "the file is cut short or no STL: export the mesh again");
}

} // namespace pith::mesh_format
