// Mesh files as bytes. Text numbers are the shortest that read back as the same double; PLY holds doubles too, and
// only STL, by its format, rounds to float.
#include "volume/io/mesh_io_formats.h"

#include <Eigen/Geometry>

namespace pith::mesh_format {
namespace {

template <class T>
void append_number(std::string& text, T value) {
  std::array<char, 32> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  static_cast<void>(error); // 32 characters hold every double and every 64-bit integer
  text.append(digits.data(), end);
}

void append_point(std::string& text, const Vec3d& p) {
  append_number(text, p.x());
  text += ' ';
  append_number(text, p.y());
  text += ' ';
  append_number(text, p.z());
  text += '\n';
}

template <class T>
void append_stored(std::string& bytes, T value) {
  const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  bytes.append(raw.data(), raw.size());
}

} // namespace

std::string obj_text(const TriMesh& mesh) {
  std::string text;
  text.reserve(60 * mesh.vertex_count() + 24 * mesh.triangle_count());
  for (const Vec3d& p : mesh.position) append_point(text += "v ", p);
  const bool parts = mesh.part.size() == mesh.triangle_count() &&
                     std::any_of(mesh.part.begin(), mesh.part.end(), [](std::int32_t part) { return part != 0; });
  for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count())) {
    if (parts && (t == 0 || mesh.part[t] != mesh.part[TriangleId(t - 1)])) {
      append_number(text += "g part", mesh.part[t]);
      text += '\n';
    }
    text += 'f';
    for (const VertexId v : mesh.corner[t]) append_number(text += ' ', v.value + 1);
    text += '\n';
  }
  return text;
}

std::string off_text(const TriMesh& mesh) {
  std::string text = "OFF\n";
  append_number(text, mesh.vertex_count());
  append_number(text += ' ', mesh.triangle_count());
  text += " 0\n";
  for (const Vec3d& p : mesh.position) append_point(text, p);
  for (const auto& corner : mesh.corner) {
    text += '3';
    for (const VertexId v : corner) append_number(text += ' ', v.value);
    text += '\n';
  }
  return text;
}

std::string ply_bytes(const TriMesh& mesh) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertex_count()) +
                      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                      std::to_string(mesh.triangle_count()) +
                      "\nproperty list uchar int vertex_indices\nend_header\n";
  bytes.reserve(bytes.size() + 24 * mesh.vertex_count() + 13 * mesh.triangle_count());
  for (const Vec3d& p : mesh.position)
    for (int axis = 0; axis < 3; ++axis) append_stored(bytes, p[axis]);
  for (const auto& corner : mesh.corner) {
    append_stored(bytes, std::uint8_t{3});
    for (const VertexId v : corner) append_stored(bytes, v.value);
  }
  return bytes;
}

std::string stl_bytes(const TriMesh& mesh) {
  std::string bytes(80, ' ');
  append_stored(bytes, static_cast<std::uint32_t>(mesh.triangle_count()));
  for (const auto& corner : mesh.corner) {
    const Vec3d &a = mesh.position[corner[0]], &b = mesh.position[corner[1]], &c = mesh.position[corner[2]];
    Vec3d normal = (b - a).cross(c - a);
    const double length = normal.norm();
    normal = length > 0 ? Vec3d(normal / length) : Vec3d::Zero();
    for (const Vec3d& p : {normal, a, b, c})
      for (int axis = 0; axis < 3; ++axis) append_stored(bytes, static_cast<float>(p[axis]));
    append_stored(bytes, std::uint16_t{0});
  }
  return bytes;
}

} // namespace pith::mesh_format
