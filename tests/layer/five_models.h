#pragma once
// Models by hand in the shape of each of the five methods, on a cube of side `size`.
#include "tests/layer/hand_written.h"

#include <cmath>

namespace pith::testing {

inline constexpr double size = 2;

/// Takayama 2008: many masked volumes. Bottom: a ramp along y, texel i = 15 i; in between half transparent red; on
/// top blue, fading in along x.
inline Model masked_volumes() {
  Model model = cube_model(2, size);
  Layer layer = solid_layer(model, size, 3);
  layer.exemplar = {exemplar_of("ramp", 3, {1, 18, 1}, Wrap::clamp, linear_color(),
                                [](int, int y, int) { return std::vector<int>(3, 15 * y); }),
                    constant("red", 3, {255, 0, 0}), constant("blue", 3, {0, 0, 255})};
  layer.mask = {full_mask(3, 255), full_mask(3, 51), ramp_mask(3, 4)};
  for (std::uint32_t p = 0; p < 3; ++p) layer.patch[p].exemplar = layer.patch[p].mask = p;
  model.layer.push_back(layer);
  return model;
}

/// Praun 2000: masked images on the boundary, over a white solid.
inline Model masked_images() {
  Model model = cube_model(2, size);
  Layer solid = solid_layer(model, size, 1);
  solid.exemplar = {constant("white", 3, {255, 255, 255})};
  solid.patch[0] = {0, Patch::no_mask, {}, 0};
  Layer skin;
  skin.name = "skin";
  skin.domain = Domain::skin;
  skin.width = 2;
  skin.exemplar = {constant("red", 2, {255, 0, 0}), constant("blue", 2, {0, 0, 255})};
  skin.mask = {full_mask(2, 102), ramp_mask(2, 6)};
  skin.patch = {{0, 0, {}, 0}, {1, 1, {}, 0}};
  LayerWriter writer(skin);
  for (FacetId f : all_ids<FacetId>(model.boundary.facet_count())) {
    std::vector<std::vector<float>> rows;
    for (VertexId v : model.boundary.corner[f]) {
      const Vec3d u = model.mesh.position[v] / size;
      rows.push_back({float(u.x()), float(u.y()), 1.0f});
    }
    writer.add(0, rows);
    writer.add(1, rows);
    writer.end_simplex();
  }
  model.layer = {solid, skin};
  return model;
}

/// Ray 2009: one look-up into a tile periodic in s and t, or three on every second triangle, whose branches differ by
/// whole periods and are weighted by the corners' barycentrics. Red rises with m, green steps with s, blue with t;
/// `shift_m` animates m.
inline Model periodic_tile(float shift_m = 0) {
  Model model = cube_model(2, size);
  Layer layer;
  layer.name = "tile";
  layer.domain = Domain::skin;
  layer.width = 3;
  layer.blend.mix = Blend::Mix::weighted;
  // Red rises with m, green steps with s (period 4 texels), blue with t.
  Exemplar tile = exemplar_of("tile", 3, {4, 4, 18}, Wrap::repeat, linear_color(), [](int x, int y, int z) {
    return std::vector<int>{15 * z, 60 * x, 60 * y};
  });
  tile.wrap[2] = Wrap::clamp;
  layer.exemplar = {tile};
  layer.patch = {{}};
  LayerWriter writer(layer);
  const auto row = [&](VertexId v, float shift, float weight) {
    const Vec3d u = model.mesh.position[v] / size;
    return std::vector<float>{float(u.x()) + shift, float(u.y()) - shift, 0.25f + 0.5f * float(u.z()), weight};
  };
  for (FacetId f : all_ids<FacetId>(model.boundary.facet_count())) {
    const auto& c = model.boundary.corner[f];
    if (f % 2 == 0) {
      writer.add(0, {row(c[0], 0, 1), row(c[1], 0, 1), row(c[2], 0, 1)});
    } else { // three branches that differ by whole periods, each weighted by its corner's barycentric
      for (int k = 0; k < 3; ++k)
        writer.add(0, {row(c[0], 3.0f * k, k == 0), row(c[1], 3.0f * k, k == 1), row(c[2], 3.0f * k, k == 2)});
    }
    writer.end_simplex();
  }
  layer.evaluation.offset[2] = shift_m;
  model.layer.push_back(layer);
  return model;
}

/// The pattern of gutter_atlas, in bytes.
inline double pattern(double u, double v) { return 20 + 100 * u + 100 * v; }

/// Ying 2001: texture maps with gutters. Two charts in one atlas; a chart's border texels are repeated in its gutter,
/// so that both sides of a chart border show the same colour.
inline Model gutter_atlas() {
  Model model = cube_model(2, size);
  Layer layer;
  layer.name = "atlas";
  layer.domain = Domain::skin;
  layer.width = 2;
  // Two cells of 8 × 8 texels side by side; in each the inner 6 × 6 carry the pattern at u ∈ [0, 1] of texel
  // centres −0.1 … 1.1, one gutter texel beyond either end.
  layer.exemplar = {exemplar_of("atlas", 2, {16, 8, 1}, Wrap::clamp, linear_color(), [&](int x, int y, int) {
    const double u = (x % 8 - 1) / 5.0, v = (y - 1) / 5.0;
    return std::vector<int>(3, static_cast<int>(std::lround(pattern(u, v))));
  })};
  layer.patch = {{}};
  LayerWriter writer(layer);
  for (FacetId f : all_ids<FacetId>(model.boundary.facet_count())) {
    std::vector<std::vector<float>> rows;
    for (VertexId v : model.boundary.corner[f]) {
      const Vec3d u = model.mesh.position[v] / size;
      const float x = float(8 * (f % 2) + 1.5 + 5 * u.x()) / 16, y = float(1.5 + 5 * u.y()) / 8;
      rows.push_back({x, y, 1.0f});
    }
    writer.add(0, rows);
    writer.end_simplex();
  }
  model.layer.push_back(layer);
  return model;
}

/// Schuster 2020: overlapping PBR patches; selection by height with grace, mixing linearly or by histogram.
inline std::vector<Channel> pbr() {
  return {{"color", Semantic::color, 3, false, 0, 1},
          {"height", Semantic::height, 1, false, 0, 1},
          {"roughness", Semantic::scalar, 1, false, 0, 1}};
}

inline Model two_patches(Blend blend, Exemplar a, Exemplar b) {
  Model model = cube_model(2, size);
  Layer layer;
  layer.name = "patches";
  layer.domain = Domain::skin;
  layer.width = 2;
  layer.blend = blend;
  layer.exemplar = {std::move(a), std::move(b)};
  layer.patch = {{0, Patch::no_mask, {}, 0}, {1, Patch::no_mask, {}, 0}};
  LayerWriter writer(layer);
  for (FacetId f : all_ids<FacetId>(model.boundary.facet_count())) {
    std::vector<std::vector<float>> first, second; // weights cross over along x
    for (VertexId v : model.boundary.corner[f]) {
      const Vec3d u = model.mesh.position[v] / size;
      first.push_back({float(u.y()), float(u.z()), 1 - float(u.x())});
      second.push_back({float(u.z()), float(u.y()), float(u.x())});
    }
    writer.add(0, first);
    writer.add(1, second);
    writer.end_simplex();
  }
  model.layer.push_back(std::move(layer));
  return model;
}

/// A skewed noise with its Gaussian twin, for two_patches.
inline Exemplar skewed_noise(std::uint64_t seed) {
  Random random(seed);
  Exemplar e = exemplar_of("noise", 2, {64, 64, 1}, Wrap::repeat, pbr(), [&](int, int, int) {
    const int v = static_cast<int>(255 * std::pow(random.uniform(), 3));
    return std::vector<int>{v, v, v, v, v};
  });
  make_gaussian_twin(e);
  return e;
}

} // namespace pith::testing
