#pragma once
// Small models for the renderer's tests: one layer, one patch, an exemplar of 2³ texels.
#include "raytrace/render.h"
#include "tests/support/tet_grid.h"

namespace pith::testing {

/// The eight texels' colours in order x, y, z; coordinates run from 0 to 1 over the mesh's bounds. `height`: eight
/// heights of 0 to 2.55 mm, or none.
inline Root root_of(TetMesh mesh, const std::array<Vec3d, 8>& color, std::span<const double> height = {}) {
  Model model;
  model.name = "test";
  Exemplar exemplar;
  exemplar.name = "corners";
  exemplar.size = {2, 2, 2, 1};
  exemplar.channel = {Channel{.srgb = false}};
  if (!height.empty())
    exemplar.channel.push_back(
        {.name = "height", .semantic = Semantic::height, .components = 1, .srgb = false, .low = 0, .high = 2.55f});
  for (std::size_t i = 0; i < color.size(); ++i) {
    for (int k = 0; k < 3; ++k) exemplar.texel.push_back(static_cast<std::uint8_t>(std::lround(255 * color[i][k])));
    if (!height.empty()) exemplar.texel.push_back(static_cast<std::uint8_t>(std::lround(100 * height[i])));
  }
  Layer layer;
  layer.name = "body";
  layer.exemplar.push_back(exemplar);
  layer.patch.push_back({});
  const Box box = bounds_of(mesh);
  for (const Vec3d& p : mesh.position) {
    for (int k = 0; k < 3; ++k) layer.corner.push_back(static_cast<float>((p[k] - box.low[k]) / box.extent()[k]));
    layer.corner.push_back(1);
  }
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
    layer.begin.push_back(t);
    const auto& c = mesh.corner[t];
    layer.lookup.push_back({0, {c[0], c[1], c[2], c[3]}});
  }
  layer.begin.push_back(static_cast<std::uint32_t>(mesh.tet_count()));
  model.boundary = boundary_of(mesh);
  model.mesh = std::move(mesh);
  model.layer.push_back(std::move(layer));
  return Root(std::move(model));
}

inline Root root_of(TetMesh mesh, const Vec3d& color) {
  std::array<Vec3d, 8> all;
  all.fill(color);
  return root_of(std::move(mesh), all);
}

inline std::array<Vec3d, 8> colorful() {
  return {Vec3d{.9, .1, .1}, Vec3d{.1, .9, .1}, Vec3d{.1, .1, .9}, Vec3d{.9, .9, .1},
          Vec3d{.1, .9, .9}, Vec3d{.9, .1, .9}, Vec3d{.9, .9, .9}, Vec3d{.2, .2, .2}};
}

/// Matte everywhere, without ground.
inline SceneOptions matte() {
  SceneOptions options;
  options.skin = options.section = {.roughness = 1, .index = 1};
  options.ground.on = false;
  return options;
}

inline Lights constant_sky(double radiance) {
  Lights lights;
  lights.environment.zenith = lights.environment.horizon = lights.environment.nadir = Vec3d::Constant(radiance);
  return lights;
}

/// Means of one pixel's colour and their standard error from independent seeds.
struct Estimate {
  double mean = 0, error = 0;
};
template <class One>
Estimate over_seeds(int seeds, const One& one) {
  double sum = 0, square = 0;
  for (int s = 0; s < seeds; ++s) {
    const double value = one(static_cast<std::uint64_t>(s + 1));
    sum += value;
    square += value * value;
  }
  const double mean = sum / seeds;
  return {mean, std::sqrt(std::max(0.0, square / seeds - mean * mean) / (seeds - 1))};
}

} // namespace pith::testing
