#pragma once
// Layers written by hand in the shape of each of the five methods, with colours known in closed form. Exemplars are
// ramps or constants whose 8-bit texels are exact, so that interpolation gives the ramp back.
#include "tests/support/tet_grid.h"
#include "volume/base/random.h"
#include "volume/layer/model.h"

#include <functional>

namespace pith::testing {

/// Linear (not sRGB) colour, so that bytes are values · 255.
inline std::vector<Channel> linear_color() { return {{"color", Semantic::color, 3, false, 0, 1}}; }

/// A volume or image of n texels along each axis with texel(x, y, z) bytes.
inline Exemplar exemplar_of(const std::string& name, int axes, std::array<int, 3> size, Wrap wrap,
                            std::vector<Channel> channels,
                            const std::function<std::vector<int>(int, int, int)>& texel) {
  Exemplar e;
  e.name = name;
  e.axes = axes;
  e.size = {size[0], size[1], size[2], 1};
  e.wrap = {wrap, wrap, wrap, wrap};
  e.channel = std::move(channels);
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x)
        for (int byte : texel(x, y, z)) e.texel.push_back(static_cast<std::uint8_t>(byte));
  return e;
}

inline Exemplar constant(const std::string& name, int axes, std::array<int, 3> rgb) {
  return exemplar_of(name, axes, {1, 1, 1}, Wrap::clamp, linear_color(), [=](int, int, int) {
    return std::vector<int>{rgb[0], rgb[1], rgb[2]};
  });
}

/// Alpha rising linearly along x from 0 at the first texel's centre to 255 at the last's.
inline Mask ramp_mask(int axes, int texels) {
  Mask m;
  m.axes = axes;
  m.size = {texels, 1, 1};
  for (int i = 0; i < texels; ++i) m.alpha.push_back(static_cast<std::uint8_t>(255 * i / (texels - 1)));
  return m;
}

inline Mask full_mask(int axes, std::uint8_t alpha) {
  Mask m;
  m.axes = axes;
  m.alpha = {alpha};
  return m;
}

/// Writes look-ups simplex by simplex: `coordinates(simplex, corner, vertex)` gives width numbers and a weight.
class LayerWriter {
public:
  LayerWriter(Layer& layer) : layer_(layer) { layer_.begin = {0}; }

  void add(std::uint32_t patch, const std::vector<std::vector<float>>& rows) {
    Lookup lookup;
    lookup.patch = patch;
    for (std::size_t i = 0; i < 4; ++i) {
      if (i < rows.size()) {
        lookup.corner[i] = static_cast<std::uint32_t>(layer_.corner_count());
        layer_.corner.insert(layer_.corner.end(), rows[i].begin(), rows[i].end());
      } else {
        lookup.corner[i] = lookup.corner[i - 1];
      }
    }
    layer_.lookup.push_back(lookup);
  }
  void end_simplex() { layer_.begin.push_back(static_cast<std::uint32_t>(layer_.lookup.size())); }

private:
  Layer& layer_;
};

/// A cube of tets from 0 to `size`, with its boundary.
inline Model cube_model(int cubes, double size) {
  Model model;
  model.name = "cube";
  model.mesh = tet_grid(cubes, cubes, cubes, size / cubes);
  model.boundary = boundary_of(model.mesh);
  return model;
}

/// A solid layer with one look-up per tet and entry of `patches`: coordinates = x / size.
inline Layer solid_layer(const Model& model, double size, std::size_t patches) {
  Layer layer;
  layer.name = "solid";
  layer.patch.resize(patches);
  LayerWriter writer(layer);
  for (TetId t : all_ids<TetId>(model.mesh.tet_count())) {
    for (std::uint32_t p = 0; p < patches; ++p) {
      std::vector<std::vector<float>> rows;
      for (VertexId v : model.mesh.corner[t]) {
        const Vec3d u = model.mesh.position[v] / size;
        rows.push_back({float(u.x()), float(u.y()), float(u.z()), 1.0f});
      }
      writer.add(p, rows);
    }
    writer.end_simplex();
  }
  return layer;
}

/// Random points strictly inside the cube.
inline std::vector<Vec3d> random_points(double size, int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3d> points;
  for (int i = 0; i < count; ++i)
    points.push_back(size * Vec3d(random.uniform(), random.uniform(), random.uniform()));
  return points;
}

} // namespace pith::testing
