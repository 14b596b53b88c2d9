// Whole things: balls pasted by hand into a cube, then sliced, hidden, bent and cut by the skin by known parts.
#include "tests/layer/hand_written.h"
#include "volume/measure/things.h"

#include <gtest/gtest.h>

#include <numbers>

namespace pith {
namespace {

using namespace testing;

constexpr double side = 10, width = 4; // mm: of the solid, and of a thing's cube
constexpr double radius = 0.35;        // of the ball in it
constexpr int texels = 40;

Mask ball_mask() {
  Mask mask;
  mask.size = {texels, texels, texels};
  for (int z = 0; z < texels; ++z)
    for (int y = 0; y < texels; ++y)
      for (int x = 0; x < texels; ++x) {
        const Vec3d u = (Vec3d(x, y, z) + Vec3d::Constant(0.5)) / texels - Vec3d::Constant(0.5);
        mask.alpha.push_back(
            static_cast<std::uint8_t>(255 * std::clamp((radius - u.norm()) * texels + 0.5, 0.0, 1.0)));
      }
  return mask;
}

using Map = std::function<Vec3d(const Vec3d&)>; ///< rest space → the mask's cube
using Keeps = std::function<bool(const Vec3d&)>;

Map around(const Vec3d& center, const Mat3d& turn = Mat3d::Identity()) {
  return [=](const Vec3d& x) { return Vec3d(turn * (x - center) / width + Vec3d::Constant(0.5)); };
}
bool everywhere(const Vec3d&) { return true; }

struct Pasted {
  Map map;
  Keeps keeps = everywhere; ///< tets, by their barycentres
  float weight = 1;
};

/// A sparse layer of balls, later ones on top; rows for all tets.
Layer things_layer(const Model& model, const std::vector<Pasted>& pasted) {
  Layer layer;
  layer.name = "things";
  layer.exemplar = {constant("grey", 3, {90, 90, 90})};
  layer.mask = {ball_mask()};
  layer.patch.resize(pasted.size());
  for (Patch& p : layer.patch) p.mask = 0;
  LayerWriter writer(layer);
  for (const TetId t : all_ids<TetId>(model.mesh.tet_count())) {
    for (std::uint32_t p = 0; p < pasted.size(); ++p) {
      if (!pasted[p].keeps(barycenter(model.mesh, t))) continue;
      std::vector<std::vector<float>> rows;
      for (const VertexId v : model.mesh.corner[t]) {
        const Vec3d u = pasted[p].map(model.mesh.position[v]);
        rows.push_back({float(u.x()), float(u.y()), float(u.z()), pasted[p].weight});
      }
      writer.add(p, rows);
    }
    writer.end_simplex();
    layer.simplex.push_back(t.value);
  }
  return layer;
}

ThingMeasure measured(const std::vector<Pasted>& pasted, const ThingOptions& options = {}) {
  Model model = cube_model(10, side);
  model.layer.push_back(things_layer(model, pasted));
  const Root root(std::move(model));
  const auto measure = thing_measure(root, root.model().layer[0], options);
  EXPECT_TRUE(measure);
  return measure.value_or(ThingMeasure{});
}

/// The part of a ball's volume beyond a plane at `distance` (of its radius) from its middle.
double cap(double distance) { return (1 - distance) * (1 - distance) * (2 + distance) / 4; }

const Vec3d middle(5, 5, 5);

TEST(ThingsMeasure, AWholeThingIsWholeHoweverItIsTurned) {
  const Mat3d turn = Eigen::AngleAxisd(0.7, Vec3d(1, 2, 3).normalized()).toRotationMatrix();
  const ThingMeasure m = measured({{around(middle)}, {around({2.5, 2.5, 7.5}, turn)}, {around({7.5, 7.5, 2.5})}});
  EXPECT_EQ(m.things, 3u);
  EXPECT_EQ(m.whole, 3u);
  EXPECT_EQ(m.cut_by_skin, 0u);
  EXPECT_LT(m.worst, 1e-4);
  EXPECT_EQ(m.whole_share(), 1);
}

TEST(ThingsMeasure, MissingTetsSliceIt) {
  // The plane x = 6 lies between cubes of the mesh, 1 mm from the middle of a ball of 1.4 mm.
  const ThingMeasure m = measured({{around(middle), [](const Vec3d& x) { return x.x() < 6; }}}, {.samples = 4000});
  EXPECT_EQ(m.whole, 0u);
  EXPECT_EQ(m.sliced, 1u);
  EXPECT_NEAR(m.worst, cap(1 / (radius * width)), 0.01);
  EXPECT_LT((m.first_broken - middle).norm(), 0.1);
}

TEST(ThingsMeasure, WeightsBelowOneSliceItToo) {
  const ThingMeasure m = measured({{around(middle), everywhere, 0.9f}});
  EXPECT_EQ(m.sliced, 1u);
  EXPECT_NEAR(m.worst, 0.1, 1e-3);
}

TEST(ThingsMeasure, ANewerThingHidesIt) {
  // Balls 2 mm apart: each reaches 0.4 mm into the other; a lens of both caps is hidden of the older one.
  const ThingMeasure m = measured({{around(middle)}, {around(middle + Vec3d(2, 0, 0))}}, {.samples = 4000});
  EXPECT_EQ(m.things, 2u);
  EXPECT_EQ(m.whole, 1u);
  EXPECT_EQ(m.hidden, 1u);
  EXPECT_NEAR(m.worst, 2 * cap(1 / (radius * width)), 0.012);
  EXPECT_LT((m.first_broken - middle).norm(), 0.1);
  EXPECT_NEAR(m.whole_share(), 0.5, 1e-12);
}

TEST(ThingsMeasure, ALayerAboveHidesItAndOneBelowDoesNot) {
  Model model = cube_model(10, side);
  model.layer.push_back(solid_layer(model, side, 1));
  model.layer[0].exemplar = {constant("ground", 3, {200, 200, 200})};
  model.layer.push_back(things_layer(model, {{around(middle)}}));
  {
    const Root root(model);
    EXPECT_EQ(thing_measure(root, root.model().layer[1])->whole, 1u);
    EXPECT_FALSE(thing_measure(root, root.model().layer[0])) << "a fill without masks holds no things";
  }
  std::swap(model.layer[0], model.layer[1]);
  const Root root(model);
  const auto m = thing_measure(root, root.model().layer[0]);
  EXPECT_EQ(m->hidden, 1u);
  EXPECT_NEAR(m->worst, 1, 1e-4);
}

TEST(ThingsMeasure, WhatTheSkinCutsIsCountedApart) {
  // 1 mm of 1.4 below the face: a cap of 2 % would do.
  const ThingMeasure m = measured({{around({1, 5, 5})}, {around(middle)}});
  EXPECT_EQ(m.things, 2u);
  EXPECT_EQ(m.cut_by_skin, 1u);
  EXPECT_EQ(m.whole, 1u);
  EXPECT_EQ(m.whole_share(), 1);
  const ThingMeasure touches = measured({{around({1.38, 5, 5})}});
  EXPECT_EQ(touches.cut_by_skin, 0u);
  EXPECT_EQ(touches.whole, 1u);
}

TEST(ThingsMeasure, BentAndMirroredThingsAreNotWhole) {
  const auto stretched = [](double factor) {
    return Map([=](const Vec3d& x) {
      const Vec3d d = (x - middle) / width;
      return Vec3d(Vec3d(d.x() * factor, d.y() / std::sqrt(factor), d.z() / std::sqrt(factor)) +
                   Vec3d::Constant(0.5));
    });
  };
  EXPECT_EQ(measured({{stretched(1.2)}}).whole, 1u); // as much as the tolerance lets pass
  const ThingMeasure m = measured({{stretched(1.4)}});
  EXPECT_EQ(m.bent, 1u);
  EXPECT_NEAR(m.worst, 1, 1e-4);
  const Mat3d mirror = Vec3d(-1, 1, 1).asDiagonal();
  EXPECT_EQ(measured({{around(middle, mirror)}}).bent, 1u);
  // Of any one size: the scale is the thing's own.
  const Map large = [](const Vec3d& x) { return Vec3d((x - middle) / (2 * width) + Vec3d::Constant(0.5)); };
  EXPECT_EQ(measured({{large}}).whole, 1u);
}

TEST(ThingsMeasure, IsTheSameForAnyThreads) {
  const std::vector<Pasted> pasted{{around(middle)}, {around(middle + Vec3d(2, 1, 0))}, {around({1, 1, 1})}};
  ThingMeasure one, two;
  {
    const ThreadLimit limit(1);
    one = measured(pasted);
  }
  {
    const ThreadLimit limit(2);
    two = measured(pasted);
  }
  EXPECT_EQ(one.worst, two.worst);
  EXPECT_EQ(one.hidden, two.hidden);
  EXPECT_EQ(one.first_broken, two.first_broken);
}

} // namespace
} // namespace pith
