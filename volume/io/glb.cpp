// GLB: the binary container of glTF 2.0 (Khronos, 2.0.1), sections 3.6 (buffers), 3.7 (meshes), 3.9 (materials), 4.4
// (GLB).
#include "volume/base/error.h"
#include "volume/io/atomic_file.h"
#include "volume/io/surface_files.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

namespace pith {

using nlohmann::json;

namespace {

constexpr double metres_per_mm = 0.001;
constexpr int float_type = 5126, uint32_type = 5125, uint16_type = 5123; // §3.6.2.2
constexpr int vertex_target = 34962, index_target = 34963;

class GlbWriter {
public:
  explicit GlbWriter(const ColoredSurface& surface) : surface_(surface) {}

  json primitive(const ColoredSurface::Part& part) {
    const std::size_t vertices = part.vertex_end - part.vertex_begin;
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    std::size_t begin = binary_.size();
    for (std::uint32_t v = part.vertex_begin; v < part.vertex_end; ++v)
      for (int i = 0; i < 3; ++i) {
        const auto x = static_cast<float>(surface_.position[surface_.vertex[v].point][i] * metres_per_mm);
        low[i] = std::min(low[i], x);
        high[i] = std::max(high[i], x);
        append(binary_, x);
      }
    const std::size_t position = accessor(begin, vertices, float_type, "VEC3", vertex_target);
    accessor_.back()["min"] = low; // required for positions (§3.7.2.1)
    accessor_.back()["max"] = high;

    begin = binary_.size();
    for (std::uint32_t v = part.vertex_begin; v < part.vertex_end; ++v)
      for (int i = 0; i < 3; ++i) append(binary_, surface_.vertex[v].normal[i]);
    const std::size_t normal = accessor(begin, vertices, float_type, "VEC3", vertex_target);

    begin = binary_.size();
    for (std::uint32_t v = part.vertex_begin; v < part.vertex_end; ++v) {
      for (int i = 0; i < 3; ++i) {
        const float linear = surface_.vertex[v].color[i];
        append(binary_, static_cast<std::uint16_t>((linear > 0 ? std::min(linear, 1.0f) : 0.0f) * 65535 + 0.5f));
      }
      append(binary_, std::uint16_t(65535)); // alpha: rows of a multiple of four bytes
    }
    const std::size_t color = accessor(begin, vertices, uint16_type, "VEC4", vertex_target);
    accessor_.back()["normalized"] = true;

    begin = binary_.size();
    for (std::uint32_t t = part.triangle_begin; t < part.triangle_end; ++t)
      for (const std::uint32_t v : surface_.triangle[t]) append(binary_, v - part.vertex_begin);
    const std::size_t index =
        accessor(begin, 3 * (part.triangle_end - part.triangle_begin), uint32_type, "SCALAR", index_target);
    return {{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"COLOR_0", color}}},
            {"indices", index},
            {"material", part.cut.exists() ? 1 : 0}};
  }

  std::string file(const std::string& name, json meshes, json nodes) {
    json scene_nodes = json::array();
    for (std::size_t n = 0; n < nodes.size(); ++n) scene_nodes.push_back(n);
    const auto material = [](const char* label, double roughness) {
      return json{{"name", label}, {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", roughness}}}};
    };
    json gltf = {{"asset", {{"version", "2.0"}, {"generator", "pith"}}},
                 {"scene", 0},
                 {"scenes", {{{"name", name}}}},
                 {"materials", {material("skin", 0.6), material("section", 0.4)}}};
    if (!nodes.empty()) { // empty lists are not allowed
      gltf["scenes"][0]["nodes"] = scene_nodes;
      gltf["nodes"] = std::move(nodes);
      gltf["meshes"] = std::move(meshes);
      gltf["accessors"] = std::move(accessor_);
      gltf["bufferViews"] = std::move(view_);
      gltf["buffers"] = {{{"byteLength", binary_.size()}}};
    }
    std::string text = gltf.dump(-1, ' ', false, json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary_.resize((binary_.size() + 3) / 4 * 4, '\0');

    const bool has_binary = !binary_.empty();
    std::string bytes = "glTF";
    append(bytes, std::uint32_t(2));
    append(bytes, static_cast<std::uint32_t>(20 + text.size() + (has_binary ? 8 + binary_.size() : 0)));
    append(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += "JSON" + text;
    if (has_binary) {
      append(bytes, static_cast<std::uint32_t>(binary_.size()));
      bytes.append("BIN\0", 4);
      bytes += binary_;
    }
    return bytes;
  }
  std::size_t bytes() const { return binary_.size(); }

private:
  std::size_t accessor(std::size_t begin, std::size_t count, int type, const char* rows, int target) {
    view_.push_back(
        {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", binary_.size() - begin}, {"target", target}});
    accessor_.push_back(
        {{"bufferView", view_.size() - 1}, {"componentType", type}, {"count", count}, {"type", rows}});
    return accessor_.size() - 1;
  }

  const ColoredSurface& surface_;
  std::string binary_;
  json view_ = json::array(), accessor_ = json::array();
};

} // namespace

SurfaceCounts write_glb(const std::filesystem::path& path, const ColoredSurface& surface, const std::string& name) {
  GlbWriter writer(surface);
  json meshes = json::array(), nodes = json::array();
  for (std::size_t begin = 0, end = 0; begin < surface.part.size(); begin = end) {
    end = piece_end(surface, begin);
    const std::string label = name + "_" + std::to_string(surface.part[begin].piece);
    json primitives = json::array();
    for (std::size_t p = begin; p < end; ++p) primitives.push_back(writer.primitive(surface.part[p]));
    nodes.push_back({{"name", label}, {"mesh", meshes.size()}});
    meshes.push_back({{"name", label}, {"primitives", std::move(primitives)}});
  }
  if (writer.bytes() > 0xf0000000u)
    throw IoFailure(path.string(), "would be larger than the 4 GB that GLB allows; give a longer max_edge");
  write_file(path, writer.file(name, std::move(meshes), std::move(nodes)));
  return {surface.triangle.size(), surface.vertex.size()};
}

} // namespace pith
