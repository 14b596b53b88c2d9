// PLY, OBJ and STL.
#include "volume/io/surface_files.h"

#include "volume/base/error.h"
#include "volume/base/image.h"
#include "volume/io/atomic_file.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>

namespace pith {

std::uint8_t srgb_byte(float linear) {
  const float clamped = linear > 0 ? std::min(linear, 1.0f) : 0.0f; // NaN becomes 0
  return static_cast<std::uint8_t>(srgb_from_linear(clamped) * 255 + 0.5f);
}

void append_text(std::string& text, float number) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof(digits), number).ptr);
}

std::size_t piece_end(const ColoredSurface& surface, std::size_t first) {
  std::size_t end = first;
  while (end < surface.part.size() && surface.part[end].piece == surface.part[first].piece) ++end;
  return end;
}

WeldedSurface welded(const ColoredSurface& surface) {
  // Points belong to one piece each, so equal points are of one piece.
  struct Key {
    std::uint32_t point, color, vertex;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<Key> key(surface.vertex.size());
  parallel_for(key.size(), 4096, [&](std::size_t v) {
    const auto& vertex = surface.vertex[v];
    std::uint32_t color = 0;
    for (int c = 0; c < 3; ++c) color = color << 8 | srgb_byte(vertex.color[c]);
    key[v] = {vertex.point, color, static_cast<std::uint32_t>(v)};
  });
  std::sort(key.begin(), key.end());

  WeldedSurface result;
  result.of.resize(key.size());
  for (std::size_t k = 0; k < key.size(); ++k) {
    const Vec3f& normal = surface.vertex[key[k].vertex].normal;
    if (k == 0 || key[k].point != key[k - 1].point || key[k].color != key[k - 1].color)
      result.vertex.push_back(
          {key[k].point,
           {std::uint8_t(key[k].color >> 16), std::uint8_t(key[k].color >> 8), std::uint8_t(key[k].color)},
           normal});
    else
      result.vertex.back().normal += normal;
    result.of[key[k].vertex] = static_cast<std::uint32_t>(result.vertex.size() - 1);
  }
  for (auto& vertex : result.vertex) {
    const float length = vertex.normal.norm();
    if (length > 0) vertex.normal /= length;
  }
  return result;
}

SurfaceCounts write_ply(const std::filesystem::path& path, const ColoredSurface& surface) {
  const WeldedSurface weld = welded(surface);
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment pith, millimetres\nelement vertex " +
      std::to_string(weld.vertex.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
      "property float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face " +
      std::to_string(surface.triangle.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  bytes.reserve(bytes.size() + 27 * weld.vertex.size() + 13 * surface.triangle.size());
  for (const auto& vertex : weld.vertex) {
    for (int i = 0; i < 3; ++i) append(bytes, static_cast<float>(surface.position[vertex.point][i]));
    for (int i = 0; i < 3; ++i) append(bytes, vertex.normal[i]);
    for (const std::uint8_t c : vertex.color) append(bytes, c);
  }
  for (const auto& triangle : surface.triangle) {
    append(bytes, std::uint8_t(3));
    for (const std::uint32_t v : triangle) append(bytes, static_cast<std::int32_t>(weld.of[v]));
  }
  write_file(path, bytes);
  return {surface.triangle.size(), weld.vertex.size()};
}

SurfaceCounts write_obj(const std::filesystem::path& path, const ColoredSurface& surface, const std::string& name) {
  const WeldedSurface weld = welded(surface);
  std::string text = "# pith, millimetres\n";
  for (const auto& vertex : weld.vertex) {
    text += "v";
    for (int i = 0; i < 3; ++i) append_text(text += ' ', static_cast<float>(surface.position[vertex.point][i]));
    for (const std::uint8_t c : vertex.color) append_text(text += ' ', static_cast<float>(c) / 255);
    text += '\n';
  }
  for (const auto& vertex : weld.vertex) {
    text += "vn";
    for (int i = 0; i < 3; ++i) append_text(text += ' ', vertex.normal[i]);
    text += '\n';
  }
  for (std::size_t p = 0; p < surface.part.size(); ++p) {
    const auto& part = surface.part[p];
    if (p == 0 || surface.part[p - 1].piece != part.piece)
      text += "o " + name + "_" + std::to_string(part.piece) + "\n";
    text += "g " + name + "_" + std::to_string(part.piece) +
            (part.cut.exists() ? "_section_" + std::to_string(part.cut) : "_skin") + "\n";
    for (std::uint32_t t = part.triangle_begin; t < part.triangle_end; ++t) {
      text += "f";
      for (const std::uint32_t v : surface.triangle[t]) {
        const std::string number = std::to_string(weld.of[v] + 1);
        text += " " + number + "//" + number;
      }
      text += '\n';
    }
  }
  write_file(path, text);
  return {surface.triangle.size(), weld.vertex.size()};
}

SurfaceCounts write_stl(const std::filesystem::path& path, const ColoredSurface& surface) {
  std::string bytes = "pith, millimetres";
  bytes.resize(80, ' ');
  append(bytes, static_cast<std::uint32_t>(surface.triangle.size()));
  bytes.reserve(bytes.size() + 50 * surface.triangle.size());
  for (const auto& triangle : surface.triangle) {
    std::array<Vec3d, 3> x;
    for (int i = 0; i < 3; ++i) x[i] = surface.position[surface.vertex[triangle[i]].point];
    Vec3d normal = (x[1] - x[0]).cross(x[2] - x[0]);
    if (const double length = normal.norm(); length > 0) normal /= length;
    for (int i = 0; i < 3; ++i) append(bytes, static_cast<float>(normal[i]));
    for (const Vec3d& corner : x)
      for (int i = 0; i < 3; ++i) append(bytes, static_cast<float>(corner[i]));
    append(bytes, std::uint16_t(0));
  }
  write_file(path, bytes);
  return {surface.triangle.size(), 0};
}

SurfaceCounts write_surface(const std::filesystem::path& path, const ColoredSurface& surface,
                            const std::string& name) {
  const std::string extension = path.extension().string();
  if (extension == ".ply") return write_ply(path, surface);
  if (extension == ".obj") return write_obj(path, surface, name);
  if (extension == ".stl") return write_stl(path, surface);
  if (extension == ".glb") return write_glb(path, surface, name);
  throw InvalidInput(path.string(), "is no name for a surface", "end it in .ply, .obj, .stl or .glb");
}

} // namespace pith
