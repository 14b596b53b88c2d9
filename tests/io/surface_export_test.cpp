#include "volume/io/surface_export.h"

#include "io_fixture.h"
#include "volume/base/error.h"
#include "volume/base/image.h"
#include "volume/io/mesh_io.h"

#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

namespace pith {
namespace {

using testing::cut_pieces;
using testing::Folder;
using testing::ramp_color;
using testing::ramp_model;

struct Scene {
  Root root;
  Pieces pieces;
  explicit Scene(bool skin) : root(ramp_model(skin)), pieces(cut_pieces(root.model())) {}
};

const Vec3d& point_of(const ColoredSurface& surface, std::uint32_t vertex) {
  return surface.position[surface.vertex[vertex].point];
}

/// Every edge between points is run through once in each direction: closed and oriented.
void expect_closed(const ColoredSurface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  for (const auto& triangle : surface.triangle)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = surface.vertex[triangle[i]].point, b = surface.vertex[triangle[(i + 1) % 3]].point;
      ++runs[{a, b}];
      --runs[{b, a}];
    }
  for (const auto& [edge, sum] : runs) ASSERT_EQ(sum, 0) << edge.first << " " << edge.second;
}

double volume_of(const ColoredSurface& surface, std::uint32_t piece) {
  double volume = 0;
  for (const auto& part : surface.part)
    if (part.piece == piece)
      for (std::uint32_t t = part.triangle_begin; t < part.triangle_end; ++t) {
        const auto& c = surface.triangle[t];
        volume += point_of(surface, c[0]).cross(point_of(surface, c[1])).dot(point_of(surface, c[2])) / 6;
      }
  return volume;
}

TEST(ColoredSurface, EachPieceIsClosedWithItsVolume) {
  const Scene scene(true);
  for (const double max_edge : {0.0, 1.3}) {
    const ColoredSurface surface = colored_surface(scene.root, scene.pieces, {.max_edge = max_edge});
    expect_closed(surface);
    for (std::uint32_t p = 0; p < scene.pieces.piece.size(); ++p) {
      const double known = measure(scene.pieces, p, scene.root.model().mesh).volume;
      EXPECT_NEAR(volume_of(surface, p), known, 1e-9 * known + 1e-9);
    }
  }
}

TEST(ColoredSurface, ReliefStandsOnTheSkinAndSectionsStay) {
  Model model = ramp_model(false);
  Exemplar& ramp = model.layer[0].exemplar[0];
  ramp.channel.push_back({.name = "height", .semantic = Semantic::height, .components = 1, .srgb = false, .high = 1});
  LargeArray<std::uint8_t> texel;
  for (std::size_t t = 0; t < ramp.texel_count(); ++t) {
    for (int c = 0; c < 3; ++c) texel.push_back(ramp.texel[3 * t + c]);
    texel.push_back(ramp.texel[3 * t]); // as it is red: x / 25 + ½
  }
  ramp.texel = std::move(texel);
  const Pieces pieces = cut_pieces(model);
  const Root root(std::move(model));
  const ColoredSurface plain = colored_surface(root, pieces, {.displacement = {.scale = 0}}),
                       relief = colored_surface(root, pieces, {.displacement = {.max_edge = 1}});
  expect_closed(relief);
  double before = 0, after = 0;
  for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) {
    before += volume_of(plain, p);
    after += volume_of(relief, p);
  }
  EXPECT_GT(after, 1.12 * before); // half a millimetre on a radius of ten
  EXPECT_LT(after, 1.18 * before);
  for (const auto& part : relief.part)
    for (std::uint32_t v = part.vertex_begin; v < part.vertex_end; ++v) {
      const Vec3d at = pieces.piece[part.piece].placement.inverse(point_of(relief, v));
      const Vec3d color = relief.vertex[v].color.cast<double>();
      const Vec3d rest = (color - Vec3d::Constant(0.5)) * 25; // what the colour says
      const double height = part.cut.exists() ? 0.0 : std::max(0.0, color.x() - 2 / 255.0);
      ASSERT_LE((at - rest).norm(), height + 0.25) << at.transpose();
    }
}

TEST(ColoredSurface, PartsRunThroughPiecesSkinFirst) {
  const Scene scene(false);
  const ColoredSurface surface = colored_surface(scene.root, scene.pieces);
  std::uint32_t triangle = 0, vertex = 0, piece = 0;
  int sections = 0;
  for (const auto& part : surface.part) {
    EXPECT_EQ(part.triangle_begin, triangle);
    EXPECT_EQ(part.vertex_begin, vertex);
    EXPECT_LT(part.triangle_begin, part.triangle_end);
    EXPECT_TRUE(part.piece == piece || part.piece == piece + 1);
    sections += part.cut.exists();
    for (std::uint32_t t = part.triangle_begin; t < part.triangle_end; ++t)
      for (const std::uint32_t v : surface.triangle[t]) ASSERT_TRUE(v >= part.vertex_begin && v < part.vertex_end);
    triangle = part.triangle_end;
    vertex = part.vertex_end;
    piece = part.piece;
  }
  EXPECT_EQ(triangle, surface.triangle.size());
  EXPECT_EQ(vertex, surface.vertex.size());
  EXPECT_EQ(piece + 1, scene.pieces.piece.size());
  EXPECT_GT(sections, 5);
}

TEST(ColoredSurface, ColorsAreThoseOfTheRestPosition) {
  const Scene scene(true);
  const ColoredSurface surface = colored_surface(scene.root, scene.pieces, {.max_edge = 2});
  for (const auto& part : surface.part)
    for (std::uint32_t v = part.vertex_begin; v < part.vertex_end; ++v) {
      const Vec3f& color = surface.vertex[v].color;
      if (!part.cut.exists()) {
        ASSERT_LT((color - Vec3f(0, 0, 1)).norm(), 1e-6f); // the skin layer
        continue;
      }
      const Vec3d rest = scene.pieces.piece[part.piece].placement.inverse(point_of(surface, v));
      const Vec3d error = color.cast<double>() - ramp_color(rest);
      ASSERT_LT(error.cwiseAbs().maxCoeff(), 1.5 / 255) << rest.transpose();
    }
}

TEST(ColoredSurface, NormalsAreUnitAndPointOutwards) {
  const Scene scene(false);
  const ColoredSurface surface = colored_surface(scene.root, scene.pieces, {.max_edge = 2});
  for (const auto& part : surface.part)
    for (std::uint32_t t = part.triangle_begin; t < part.triangle_end; ++t) {
      const auto& c = surface.triangle[t];
      const Vec3d area = (point_of(surface, c[1]) - point_of(surface, c[0]))
                             .cross(point_of(surface, c[2]) - point_of(surface, c[0]));
      for (const std::uint32_t v : c) {
        const Vec3f& normal = surface.vertex[v].normal;
        ASSERT_NEAR(normal.norm(), 1, 1e-5);
        if (area.norm() > 1e-4) {
          ASSERT_GT(area.normalized().dot(normal.cast<double>()), 0.5);
        }
        if (part.cut.exists()) continue;
        const Vec3d rest = scene.pieces.piece[part.piece].placement.inverse(point_of(surface, v));
        const Vec3d rest_normal =
            scene.pieces.piece[part.piece].placement.rotation.transpose() * normal.cast<double>();
        ASSERT_GT(rest.normalized().dot(rest_normal), 0.9);
      }
    }
}

TEST(ColoredSurface, SubdivisionLeavesNoLongEdgeAndNoCrack) {
  const Scene scene(false);
  const ColoredSurface coarse = colored_surface(scene.root, scene.pieces);
  for (const double max_edge : {3.0, 0.7}) {
    const ColoredSurface fine = colored_surface(scene.root, scene.pieces, {.max_edge = max_edge});
    EXPECT_GT(fine.triangle.size(), coarse.triangle.size());
    expect_closed(fine);
    for (const auto& c : fine.triangle)
      for (int i = 0; i < 3; ++i)
        ASSERT_LE((point_of(fine, c[i]) - point_of(fine, c[(i + 1) % 3])).norm(), max_edge * (1 + 1e-9));
  }
  EXPECT_THROW(colored_surface(scene.root, scene.pieces, {.max_edge = 0.1, .max_triangles = 20000}), InvalidInput);
  EXPECT_THROW(colored_surface(scene.root, scene.pieces, {.max_edge = 1e-9}), InvalidInput); // at once
  EXPECT_THROW(colored_surface(scene.root, scene.pieces, {.max_edge = -1}), InvalidInput);
  EXPECT_THROW(colored_surface(scene.root, scene.pieces, {}, [](double) { return false; }), Cancelled);
}

TEST(ColoredSurface, SameForAnyNumberOfThreads) {
  const Folder folder;
  const Scene scene(true);
  for (const char* name : {"a.ply", "a.obj", "a.stl", "a.glb"}) {
    const std::string extension = std::string(name).substr(1);
    {
      const ThreadLimit one(1);
      write_surface(folder / name, colored_surface(scene.root, scene.pieces, {.max_edge = 1}));
    }
    write_surface(folder / ("b" + extension), colored_surface(scene.root, scene.pieces, {.max_edge = 1}));
    EXPECT_EQ(file_content(folder / name), file_content(folder / ("b" + extension))) << name;
  }
}

TEST(SurfaceFiles, PlyAndObjAreWatertightByIndexWithoutASkin) {
  const Folder folder;
  const Scene scene(false);
  const ColoredSurface surface = colored_surface(scene.root, scene.pieces);
  for (const char* name : {"a.ply", "a.obj", "a.stl"}) {
    write_surface(folder / name, surface);
    const TriMesh mesh = read_tri_mesh(folder / name);
    ASSERT_EQ(mesh.triangle_count(), surface.triangle.size()) << name;
    double volume = 0;
    for (std::uint32_t p = 0; p < scene.pieces.piece.size(); ++p) volume += volume_of(surface, p);
    EXPECT_NEAR(signed_volume(mesh), volume, 1e-4 * volume) << name;
    if (std::string(name) == "a.stl") continue;
    EXPECT_EQ(mesh.vertex_count(), surface.position.size()) << name;
    const SurfaceDefects defects = surface_defects(mesh);
    EXPECT_EQ(defects.border_edges, 0u) << name;
    EXPECT_EQ(defects.misoriented_edges, 0u) << name;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
      ASSERT_LT((mesh.position[VertexId(v)] - surface.position[v]).norm(), 1e-4);
  }
}

TEST(SurfaceFiles, TheRimKeepsTwoColorsWhereASkinLayerEnds) {
  const Folder folder;
  const Scene scene(true);
  const ColoredSurface surface = colored_surface(scene.root, scene.pieces);
  std::map<std::uint32_t, int> sides; // bit 0: skin, bit 1: section
  for (const auto& part : surface.part)
    for (std::uint32_t v = part.vertex_begin; v < part.vertex_end; ++v)
      sides[surface.vertex[v].point] |= part.cut.exists() ? 2 : 1;
  std::size_t rim = 0;
  for (const auto& [point, side] : sides) rim += side == 3;
  ASSERT_GT(rim, 50u);
  write_ply(folder / "a.ply", surface);
  EXPECT_EQ(read_tri_mesh(folder / "a.ply").vertex_count(), surface.position.size() + rim);
}

TEST(SurfaceFiles, PlyHoldsSrgbBytes) {
  const Folder folder;
  const Scene scene(false);
  const ColoredSurface surface = colored_surface(scene.root, scene.pieces);
  write_ply(folder / "a.ply", surface);
  const std::string bytes = file_content(folder / "a.ply");
  const std::size_t data = bytes.find("end_header\n") + 11;
  // Points are in order, and there is one vertex per point.
  for (const auto& vertex : surface.vertex)
    for (int c = 0; c < 3; ++c) {
      const auto stored = static_cast<unsigned char>(bytes[data + 27 * vertex.point + 24 + c]);
      ASSERT_EQ(stored, std::lround(255 * srgb_from_linear(vertex.color[c])));
    }
}

TEST(SurfaceFiles, GlbIsWhatItsSpecificationSays) {
  const Folder folder;
  const Scene scene(true);
  const ColoredSurface surface = colored_surface(scene.root, scene.pieces);
  write_glb(folder / "a.glb", surface, "kiwi");
  const std::string bytes = file_content(folder / "a.glb");
  const auto word = [&](std::size_t at) {
    std::uint32_t value;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  ASSERT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), bytes.size());
  const std::uint32_t json_bytes = word(12);
  EXPECT_EQ(json_bytes % 4, 0u);
  const auto gltf = nlohmann::json::parse(bytes.substr(20, json_bytes));
  const std::size_t binary = 20 + json_bytes + 8;
  ASSERT_EQ(word(20 + json_bytes) + binary, bytes.size());
  EXPECT_EQ(gltf["meshes"].size(), scene.pieces.piece.size());
  std::size_t triangles = 0, parts = 0;
  Box box;
  for (const auto& mesh : gltf["meshes"])
    for (const auto& primitive : mesh["primitives"]) {
      const auto& part = surface.part[parts++];
      const auto accessor = [&](const nlohmann::json& index) { return gltf["accessors"][index.get<std::size_t>()]; };
      const auto view = [&](const nlohmann::json& a) {
        const auto v = gltf["bufferViews"][a["bufferView"].get<std::size_t>()];
        EXPECT_EQ(v["byteOffset"].get<std::size_t>() % 4, 0u);
        EXPECT_LE(v["byteOffset"].get<std::size_t>() + v["byteLength"].get<std::size_t>(), bytes.size() - binary);
        return binary + v["byteOffset"].get<std::size_t>();
      };
      const auto position = accessor(primitive["attributes"]["POSITION"]);
      const auto color = accessor(primitive["attributes"]["COLOR_0"]);
      const auto index = accessor(primitive["indices"]);
      const std::size_t position_at = view(position), color_at = view(color), index_at = view(index);
      ASSERT_EQ(position["count"], part.vertex_end - part.vertex_begin);
      for (std::uint32_t v = part.vertex_begin; v < part.vertex_end; ++v) {
        float x[3];
        std::memcpy(x, bytes.data() + position_at + 12 * (v - part.vertex_begin), 12);
        box.add(1000 * Vec3d(x[0], x[1], x[2]));
        ASSERT_LT((1000 * Vec3d(x[0], x[1], x[2]) - point_of(surface, v)).norm(), 1e-4);
        std::uint16_t c[4];
        std::memcpy(c, bytes.data() + color_at + 8 * (v - part.vertex_begin), 8);
        for (int i = 0; i < 3; ++i) ASSERT_NEAR(c[i] / 65535.0, surface.vertex[v].color[i], 1e-5);
      }
      for (std::size_t i = 0; i < index["count"].get<std::size_t>(); ++i)
        ASSERT_LT(word(index_at + 4 * i), part.vertex_end - part.vertex_begin);
      triangles += index["count"].get<std::size_t>() / 3;
    }
  EXPECT_EQ(parts, surface.part.size());
  EXPECT_EQ(triangles, surface.triangle.size());
}

TEST(SurfaceFiles, UnknownNamesAreRefused) {
  const Folder folder;
  EXPECT_THROW(write_surface(folder / "a.fbx", {}), InvalidInput);
  EXPECT_THROW(write_surface(folder / "missing" / "a.ply", {}), IoFailure);
  for (const char* name : {"a.ply", "a.obj", "a.stl", "a.glb"})
    write_surface(folder / name, {}); // nothing: a valid file
  EXPECT_EQ(folder.file_count(), 4u);
}

TEST(VtuFile, HoldsTheTetsOfAllPieces) {
  const Folder folder;
  const Scene scene(false);
  write_vtu(folder / "a.vtu", scene.root, scene.pieces);
  const std::string bytes = file_content(folder / "a.vtu");
  std::size_t cells = 0;
  double known = 0;
  for (std::uint32_t p = 0; p < scene.pieces.piece.size(); ++p) {
    const PieceMeasure about = measure(scene.pieces, p, scene.root.model().mesh);
    cells += about.whole_tets + about.cut_tets;
    known += about.volume;
  }
  EXPECT_NE(bytes.find("NumberOfCells=\"" + std::to_string(cells) + "\""), bytes.npos);

  const std::size_t data = bytes.find("encoding=\"raw\">\n_") + 17;
  const auto array = [&]<class T>(const std::string& name, T) {
    const std::size_t entry = bytes.find("Name=\"" + name + "\"");
    const std::size_t offset = std::stoul(bytes.substr(bytes.find("offset=\"", entry) + 8));
    std::uint64_t length;
    std::memcpy(&length, bytes.data() + data + offset, 8);
    std::vector<T> values(length / sizeof(T));
    std::memcpy(values.data(), bytes.data() + data + offset + 8, length);
    return values;
  };
  const auto position = array("Points", double());
  const auto corner = array("connectivity", std::int64_t());
  const auto piece = array("piece", std::int32_t());
  const auto color = array("color", float()); // the first of that name: at points
  ASSERT_EQ(corner.size(), 4 * cells);
  ASSERT_EQ(color.size(), position.size());
  double volume = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    std::array<Vec3d, 4> x;
    for (int i = 0; i < 4; ++i) {
      const std::size_t v = static_cast<std::size_t>(corner[4 * c + i]);
      x[i] = Vec3d(position[3 * v], position[3 * v + 1], position[3 * v + 2]);
      const Vec3d rest = scene.pieces.piece[piece[c]].placement.inverse(x[i]);
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(color[3 * v + k], ramp_color(rest)[k], 1.5 / 255);
    }
    volume += (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) / 6;
  }
  EXPECT_NEAR(volume, known, 1e-9 * known);
}

} // namespace
} // namespace pith
