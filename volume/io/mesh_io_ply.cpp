// PLY (Stanford polygon file format; Turk 1994): text, and binary of both byte orders; any elements and properties,
// of which x, y, z of "vertex", the index list of "face" and that of "tristrips" are used.
#include "volume/io/mesh_io_formats.h"

#include <cmath>

namespace pith::mesh_format {
namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class Encoding { text, little, big };

struct Property {
  std::string name;
  Type type = Type::float32;
  bool list = false;
  Type count_type = Type::uint8;
};
struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> property;
};
struct Header {
  Encoding encoding = Encoding::text;
  std::vector<Element> element;
  std::size_t bytes = 0; ///< where the data begin
};

std::size_t size_of(Type type) {
  switch (type) {
  case Type::int8:
  case Type::uint8:
    return 1;
  case Type::int16:
  case Type::uint16:
    return 2;
  case Type::int32:
  case Type::uint32:
  case Type::float32:
    return 4;
  case Type::float64:
    return 8;
  }
  return 0;
}

Type type_of(std::string_view word, const TextCursor& cursor) {
  constexpr std::pair<std::string_view, Type> names[] = {
      {"char", Type::int8},     {"int8", Type::int8},       {"uchar", Type::uint8},    {"uint8", Type::uint8},
      {"short", Type::int16},   {"int16", Type::int16},     {"ushort", Type::uint16},  {"uint16", Type::uint16},
      {"int", Type::int32},     {"int32", Type::int32},     {"uint", Type::uint32},    {"uint32", Type::uint32},
      {"float", Type::float32}, {"float32", Type::float32}, {"double", Type::float64}, {"float64", Type::float64}};
  for (const auto& [name, type] : names)
    if (name == word) return type;
  cursor.fail("a property has an unknown type");
}

Header header_of(std::string_view bytes, const std::string& name) {
  TextCursor cursor(bytes, name);
  if (cursor.word() != "ply")
    cursor.fail("it does not begin with 'ply'", "this is not a PLY file: check its extension");
  cursor.skip_line();
  Header header;
  bool has_format = false;
  for (;; cursor.skip_line()) {
    if (cursor.at_end()) cursor.fail("the file ends before 'end_header'");
    const std::string_view keyword = cursor.word();
    if (keyword == "end_header") break;
    if (keyword == "format") {
      const std::string_view encoding = cursor.word();
      if (encoding == "ascii")
        header.encoding = Encoding::text;
      else if (encoding == "binary_little_endian")
        header.encoding = Encoding::little;
      else if (encoding == "binary_big_endian")
        header.encoding = Encoding::big;
      else
        cursor.fail("the format is none of ascii, binary_little_endian, binary_big_endian");
      has_format = true;
    } else if (keyword == "element") {
      Element element;
      element.name = cursor.word();
      const std::int64_t count = cursor.integer("the count of an element");
      if (count < 0) cursor.fail("element '" + element.name + "' has a negative count");
      element.count = static_cast<std::uint64_t>(count);
      header.element.push_back(element);
    } else if (keyword == "property") {
      if (header.element.empty()) cursor.fail("a property stands before the first element");
      Property property;
      std::string_view word = cursor.word();
      if (word == "list") {
        property.list = true;
        property.count_type = type_of(cursor.word(), cursor);
        if (property.count_type == Type::float32 || property.count_type == Type::float64)
          cursor.fail("a list has a count that is no whole number");
        word = cursor.word();
      }
      property.type = type_of(word, cursor);
      property.name = cursor.word();
      header.element.back().property.push_back(property);
    } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
      cursor.fail("the header has a line that is not PLY");
    }
  }
  if (!has_format) cursor.fail("the header has no 'format' line");

  // Binary data begin right after the header's last line end, of the same kind as the first one.
  header.bytes = bytes.find("end_header") + std::string_view("end_header").size();
  for (std::size_t at = bytes.find("end_header"); at != bytes.npos; at = bytes.find("end_header", at + 1))
    if (at > 0 && (bytes[at - 1] == '\n' || bytes[at - 1] == '\r')) {
      header.bytes = at + std::string_view("end_header").size();
      break;
    }
  const std::size_t first_end = bytes.find_first_of("\r\n");
  const bool returns = bytes[first_end] == '\r';
  const bool both = returns && first_end + 1 < bytes.size() && bytes[first_end + 1] == '\n';
  while (header.bytes < bytes.size() && (bytes[header.bytes] == ' ' || bytes[header.bytes] == '\t')) ++header.bytes;
  if (header.bytes < bytes.size()) header.bytes += both ? 2 : 1;
  header.bytes = std::min(header.bytes, bytes.size());
  return header;
}

/// Reads one value after the other, whatever the encoding.
class Values {
public:
  Values(std::string_view bytes, const Header& header, const std::string& name)
      : bytes_(bytes), at_(header.bytes), encoding_(header.encoding), text_(bytes.substr(header.bytes), name),
        name_(name), header_lines_(std::count(bytes.begin(), bytes.begin() + header.bytes, '\n')) {}

  [[noreturn]] void fail(const std::string& what) const {
    const std::string place = encoding_ == Encoding::text ? ", line " + std::to_string(header_lines_ + text_.line())
                                                          : ", byte " + std::to_string(at_);
    throw InvalidInput(name_ + place, what, "the file is damaged or cut short: export the mesh again");
  }
  double next(Type type) {
    if (encoding_ == Encoding::text) {
      const std::string_view word = next_word();
      const char* first = word.data() + (word.substr(0, 1) == "+");
      double value = 0;
      const auto [end, error] = std::from_chars(first, word.data() + word.size(), value);
      if (error == std::errc::result_out_of_range) return word.find('-', 1) != word.npos ? 0.0 : HUGE_VAL;
      if (error != std::errc() || end != word.data() + word.size()) fail("there is no number where one belongs");
      return value;
    }
    const std::size_t size = size_of(type);
    if (bytes_.size() - at_ < size) fail("the file ends inside the data");
    const char* at = bytes_.data() + at_;
    at_ += size;
    const bool big = encoding_ == Encoding::big;
    switch (type) {
    case Type::int8:
      return stored<std::int8_t>(at, big);
    case Type::uint8:
      return stored<std::uint8_t>(at, big);
    case Type::int16:
      return stored<std::int16_t>(at, big);
    case Type::uint16:
      return stored<std::uint16_t>(at, big);
    case Type::int32:
      return stored<std::int32_t>(at, big);
    case Type::uint32:
      return stored<std::uint32_t>(at, big);
    case Type::float32:
      return stored<float>(at, big);
    case Type::float64:
      return stored<double>(at, big);
    }
    return 0;
  }
  /// The length of a list; never more than what is left of the file can hold.
  std::size_t next_length(const Property& property) {
    const double length = next(property.count_type);
    const std::size_t left =
        encoding_ == Encoding::text ? bytes_.size() : (bytes_.size() - at_) / size_of(property.type);
    if (!(length >= 0) || length != std::floor(length) || length > static_cast<double>(left))
      fail("a list of '" + property.name + "' has an impossible length");
    return static_cast<std::size_t>(length);
  }

private:
  std::string_view next_word() {
    while (!text_.at_end()) {
      const std::string_view word = text_.word();
      if (!word.empty()) return word;
      text_.skip_line();
    }
    fail("the file ends inside the data");
  }

  std::string_view bytes_;
  std::size_t at_;
  Encoding encoding_;
  TextCursor text_;
  std::string name_;
  std::size_t header_lines_;
};

VertexId checked_vertex(double index, std::uint64_t vertices, const Values& values) {
  if (!(index >= 0) || index != std::floor(index) || index >= static_cast<double>(vertices))
    values.fail("a face names vertex " + std::to_string(static_cast<long long>(std::isfinite(index) ? index : -1)) +
                " of " + std::to_string(vertices));
  return VertexId(static_cast<std::uint32_t>(index));
}

/// A strip alternates its orientation; −1 starts the next one.
void add_strips(TriMesh& mesh, const std::vector<double>& indices, std::uint64_t vertices, const Values& values) {
  std::vector<VertexId> strip;
  for (const double index : indices) {
    if (index == -1) {
      strip.clear();
      continue;
    }
    strip.push_back(checked_vertex(index, vertices, values));
    const std::size_t n = strip.size();
    if (n < 3) continue;
    const bool odd = n % 2 == 0;
    const std::array<VertexId, 3> corner = {strip[n - 3], strip[odd ? n - 1 : n - 2], strip[odd ? n - 2 : n - 1]};
    if (corner[0] != corner[1] && corner[1] != corner[2] && corner[2] != corner[0]) mesh.corner.push_back(corner);
  }
}

} // namespace

TriMesh read_ply(std::string_view bytes, const std::string& name) {
  const Header header = header_of(bytes, name);
  Values values(bytes, header, name);
  TriMesh mesh;
  std::uint64_t vertices = 0;
  for (const Element& element : header.element)
    if (element.name == "vertex") vertices = element.count;

  std::vector<double> list;
  std::vector<VertexId> polygon;
  for (const Element& element : header.element) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face",
               is_strip = element.name == "tristrips";
    std::array<int, 3> place = {-1, -1, -1};
    int indices = -1;
    for (int p = 0; p < static_cast<int>(element.property.size()); ++p) {
      const Property& property = element.property[static_cast<std::size_t>(p)];
      for (int axis = 0; axis < 3; ++axis)
        if (!property.list && property.name == std::string(1, static_cast<char>('x' + axis)))
          place[static_cast<std::size_t>(axis)] = p;
      if (property.list && (property.name == "vertex_indices" || property.name == "vertex_index")) indices = p;
    }
    if (element.property.empty()) continue; // takes no bytes
    if (element.count > bytes.size())
      values.fail("element '" + element.name + "' announces " + std::to_string(element.count) +
                  " entries, more than a file of " + std::to_string(bytes.size()) + " bytes can hold");
    if (is_vertex && (place[0] < 0 || place[1] < 0 || place[2] < 0)) values.fail("the vertices have no x, y, z");
    if ((is_face || is_strip) && indices < 0) values.fail("the faces have no list 'vertex_indices'");
    if (is_vertex) mesh.position.reserve(element.count);
    if (is_face) mesh.corner.reserve(element.count);

    for (std::uint64_t n = 0; n < element.count; ++n) {
      Vec3d point = Vec3d::Zero();
      list.clear();
      for (int p = 0; p < static_cast<int>(element.property.size()); ++p) {
        const Property& property = element.property[static_cast<std::size_t>(p)];
        if (!property.list) {
          const double value = values.next(property.type);
          for (int axis = 0; axis < 3; ++axis)
            if (place[static_cast<std::size_t>(axis)] == p) point[axis] = value;
          continue;
        }
        const std::size_t length = values.next_length(property);
        for (std::size_t i = 0; i < length; ++i) {
          const double value = values.next(property.type);
          if (p == indices) list.push_back(value);
        }
      }
      if (is_vertex) {
        if (!point.allFinite()) values.fail("vertex " + std::to_string(n) + " is not finite");
        mesh.position.push_back(point);
      } else if (is_face) {
        polygon.clear();
        for (const double index : list) polygon.push_back(checked_vertex(index, vertices, values));
        add_fan(mesh, polygon);
      } else if (is_strip) {
        add_strips(mesh, list, vertices, values);
      }
    }
  }
  // An element "vertex" without properties announces vertices that the file does not hold.
  for (const auto& corner : mesh.corner)
    for (const VertexId v : corner)
      if (v.value >= mesh.vertex_count()) values.fail("the faces name vertices that the file does not hold");
  return mesh;
}

} // namespace pith::mesh_format
