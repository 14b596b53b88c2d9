#pragma once
// A bent bar, filled as each type of texture asks, and measures of how well a fill follows its frames.
#include "tests/support/tet_grid.h"
#include "volume/base/random.h"
#include "volume/field/frames.h"
#include "volume/lap/lap.h"
#include "volume/layer/composite.h"
#include "volume/layer/model.h"

#include <Eigen/LU>
#include <numbers>

namespace pith::testing {

/// An exemplar of smooth noise in three colours, 32³.
inline Exemplar noise_exemplar(std::array<Wrap, 3> wrap) {
  Exemplar e;
  e.name = "noise";
  e.size = {32, 32, 32, 1};
  for (int a = 0; a < 3; ++a) e.wrap[a] = wrap[a];
  e.channel = {Channel{}};
  Random random(4);
  std::array<double, 9> phase;
  for (double& p : phase) p = 2 * std::numbers::pi * random.uniform();
  for (int z = 0; z < 32; ++z)
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x)
        for (int c = 0; c < 3; ++c) {
          const double u = 2 * std::numbers::pi / 32;
          const double v = std::sin(u * x * (c + 1) + phase[c]) + std::sin(u * y * (c + 1) + phase[3 + c]) +
                           std::sin(u * z * (c + 1) + phase[6 + c]);
          e.texel.push_back(static_cast<std::uint8_t>(127.5 + 40 * v));
        }
  return e;
}

/// A bar 8 × 8 mm thick along a quarter circle of 24 mm around the y axis: (radius, y, angle) ↦ rest space.
struct BentBar {
  static constexpr double radius = 24, width = 8;
  TetMesh mesh;
  Boundary boundary;
  Locator locator;

  explicit BentBar(int n = 5) : mesh(bent(n)), boundary(boundary_of(mesh)), locator(mesh, boundary) {}
  BentBar(const BentBar&) = delete;

  static TetMesh bent(int n) {
    TetMesh mesh = tet_grid(n, n, 5 * n, 1.0 / n); // [0, 1]² × [0, 5]
    for (Vec3d& p : mesh.position) p = place(p.x(), p.y(), p.z() / 5);
    return mesh;
  }
  /// From [0, 1]³: across the bar, upwards, along it.
  static Vec3d place(double across, double up, double along) {
    const double r = radius + width * (across - 0.5), angle = along * std::numbers::pi / 2;
    return {r * std::cos(angle), width * (up - 0.5), r * std::sin(angle)};
  }
  static Vec3d outwards(const Vec3d& x) { return Vec3d(x.x(), 0, x.z()).normalized(); }
  static Vec3d tangent(const Vec3d& x) { return Vec3d(-x.z(), 0, x.x()).normalized(); }

  AxisStroke stroke(double across, double up, bool backwards = false) const {
    AxisStroke s;
    for (int i = 0; i <= 20; ++i) s.point.push_back(place(across, up, backwards ? 1 - i / 20.0 : i / 20.0));
    return s;
  }

  /// A field in closed form: value from the three coordinates of place().
  template <class Value>
  DepthField field(const Value& value) const {
    DepthField f;
    const auto at = [&](const Vec3d& x) {
      const double across = (Vec3d(x.x(), 0, x.z()).norm() - radius) / width + 0.5;
      return value(across, x.y() / width + 0.5, std::atan2(x.z(), x.x()) / (std::numbers::pi / 2));
    };
    for (const Vec3d& p : mesh.position) f.value.push_back(static_cast<float>(std::clamp(at(p), 0.0, 1.0)));
    for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
      const Vec3d x = barycenter(mesh, t);
      Vec3d g;
      for (int k = 0; k < 3; ++k) g[k] = (at(x + 1e-4 * Vec3d::Unit(k)) - at(x - 1e-4 * Vec3d::Unit(k))) / 2e-4;
      f.gradient.push_back(g);
    }
    return f;
  }
  /// From the inner side of the bend (0) to the outer (1); down (so that the three are right-handed); along.
  DepthField across() const {
    return field([](double a, double, double) { return a; });
  }
  DepthField downwards() const {
    return field([](double, double u, double) { return 1 - u; });
  }
  DepthField lengthwise() const {
    return field([](double, double, double l) { return l; });
  }
};

/// All that one type of texture needs on the bar.
struct TypeCase {
  const BentBar& bar;
  TextureType type;
  DepthField depth, along, around;
  FrameField frames;
  Exemplar exemplar;
  LapOptions options;

  TypeCase(const BentBar& bar, TextureType type, double scale = 8) : bar(bar), type(type) {
    const TextureTraits& traits = traits_of(type);
    std::vector<AxisStroke> strokes;
    if (traits.uses_stroke) strokes = {bar.stroke(0.5, 0.5)};
    if (traits.uses_depth) depth = bar.across();
    if (traits.imposed[2]) along = bar.lengthwise();
    if (traits.imposed[0]) around = bar.downwards();
    frames = frames_of({.mesh = bar.mesh,
                        .locator = bar.locator,
                        .depth = traits.uses_depth ? &depth : nullptr,
                        .along = traits.imposed[2] ? &along : nullptr,
                        .around = traits.imposed[0] ? &around : nullptr,
                        .stroke = strokes,
                        .scale = traits.uses_scale ? scale : 0});
    std::array<Wrap, 3> wrap;
    for (int a = 0; a < 3; ++a) wrap[a] = traits.imposed[a] ? Wrap::clamp : Wrap::repeat;
    exemplar = noise_exemplar(wrap);
    options.type = type;
  }

  LapInput input() const {
    return {.mesh = bar.mesh,
            .boundary = bar.boundary,
            .axes = frames.axes,
            .scale = frames.scale,
            .coordinate = {{around.value, depth.value, along.value}},
            .singular = frames.singular};
  }
  LapResult filled() const { return lap(input(), exemplar, options); }
};

/// The columns ∂x/∂u of a look-up's inverse map: where in rest space the exemplar's axes point, mm per texture width.
inline Mat3d pasted_axes(const TetMesh& mesh, TetId t, const Layer& layer, const Lookup& lookup) {
  Mat3d edges, texture;
  const float* first = layer.corner.data() + std::size_t(lookup.corner[0]) * 4;
  for (int k = 0; k < 3; ++k) {
    edges.col(k) = mesh.position[mesh.corner[t][k + 1]] - mesh.position[mesh.corner[t][0]];
    const float* other = layer.corner.data() + std::size_t(lookup.corner[k + 1]) * 4;
    for (int a = 0; a < 3; ++a)
      texture(a, k) = double(layer.patch[lookup.patch].frame.scale[a]) * (other[a] - first[a]);
  }
  return edges * texture.inverse();
}

} // namespace pith::testing
