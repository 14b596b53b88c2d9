// Slices of models and exemplars, windows, the slice metric, seams and whole things.
#include "tests/layer/hand_written.h"
#include "tests/measure/pictures.h"
#include "volume/base/error.h"
#include "volume/measure/objects.h"
#include "volume/measure/seams.h"
#include "volume/measure/slice_metric.h"

#include <gtest/gtest.h>

#include <numbers>

namespace pith {
namespace {

using namespace testing;

constexpr double side = 10;

/// Periodic noise in three channels; with `depth` the brightness rises along y, which is clamped.
Exemplar noise_exemplar(bool depth, int size = 32) {
  const int cells = 8;
  Exemplar e = exemplar_of("noise", 3, {size, size, size}, Wrap::repeat, linear_color(), [&](int x, int y, int z) {
    std::vector<int> rgb;
    for (int c = 0; c < 3; ++c) {
      double sum = 0, fx = double(x) * cells / size, fy = double(y) * cells / size, fz = double(z) * cells / size;
      for (int k = 0; k < 8; ++k) {
        const int ix = int(fx) + (k & 1), iy = int(fy) + (k >> 1 & 1), iz = int(fz) + (k >> 2);
        const double wx = 1 - std::abs(fx - ix), wy = 1 - std::abs(fy - iy), wz = 1 - std::abs(fz - iz);
        sum += wx * wy * wz * unit_double(hash_of(9, c, ix % cells, iy % cells, iz % cells));
      }
      rgb.push_back(depth ? int(40 + 120.0 * y / size + 80 * sum) : int(20 + 215 * sum));
    }
    return rgb;
  });
  if (depth) e.wrap[1] = Wrap::clamp;
  return e;
}

/// A cube of `widths` texture widths with one exact map, so that it shows the exemplar itself.
Model exact_model(const Exemplar& exemplar, double widths, int cubes = 6) {
  Model model = cube_model(cubes, side);
  Layer layer = solid_layer(model, side / widths, 1);
  layer.exemplar = {exemplar};
  model.field.axes.assign(model.mesh.tet_count(), Mat3d::Identity());
  model.field.scale.assign(model.mesh.tet_count(), float(side / widths));
  if (exemplar.wrap[1] == Wrap::clamp)
    for (const Vec3d& p : model.mesh.position) model.field.depth.push_back(float(p.y() * widths / side));
  model.layer.push_back(std::move(layer));
  return model;
}

TEST(Slice, GridsFrameWhatTheyCut) {
  Box box;
  box.add(Vec3d(0, 0, 0));
  box.add(Vec3d(10, 20, 30));
  const SliceGrid g = framed_grid(box, {0, 0, 2}, 10, 0.5); // z = 5
  EXPECT_EQ(g.width, 20);
  EXPECT_EQ(g.height, 40);
  EXPECT_LT((g.at(0, 0) - Vec3d(0.25, 19.75, 5)).norm(), 1e-12); // y up
  EXPECT_LT((g.at(19, 39) - Vec3d(9.75, 0.25, 5)).norm(), 1e-12);
  const Vec3d n = Vec3d(1, 2, 3).normalized();
  const SliceGrid oblique = framed_grid(box, n, 20, 0.5);
  EXPECT_NEAR(oblique.right.norm(), 0.5, 1e-12);
  EXPECT_NEAR(oblique.right.dot(oblique.down), 0, 1e-12);
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(oblique.width - 1, 3)})
    EXPECT_NEAR(oblique.at(x, y).dot(n), 20, 1e-9);
  EXPECT_THROW(framed_grid(box, Vec3d::Zero(), 0, 1), InvalidInput);
  EXPECT_THROW(framed_grid(box, n, 0, 0), InvalidInput);
}

TEST(Slice, OfAModelIsWhatItHasThere) {
  const Root root(exact_model(noise_exemplar(true), 1));
  const SliceGrid grid = centered_grid({5, 5, 5}, {0.3, 0.1, 0}, {0, 0.1, 0.4}, 40, 30); // leaves the cube
  const Slice slice = model_slice(root, grid, {.sources = true});
  const ExemplarSlicer slicer(root.model().layer[0].exemplar[0]);
  std::size_t outside = 0;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      const std::size_t i = slice.index(x, y);
      const Vec3d p = grid.at(x, y);
      const bool inside = (p.array() >= 0).all() && (p.array() <= side).all();
      EXPECT_EQ(slice.inside[i] != 0, inside);
      outside += !inside;
      if (!inside) continue;
      EXPECT_NEAR(slice.depth[i], p.y() / side, 1e-5);
      EXPECT_EQ(slice.source[i].patch, 0u);
      EXPECT_EQ(slice.source[i].share, 1);
      const Vec3f expected = slicer.color(p / side);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(slice.source[i].coordinate[c], p[c] / side, 1e-5);
        EXPECT_NEAR(slice.color.at(x, y)[c], expected[c], 1e-3);
      }
    }
  EXPECT_GT(outside, 50u);
}

TEST(Slice, OfAnExemplarWrapsAndEnds) {
  const Exemplar e = noise_exemplar(true);
  const ExemplarSlicer slicer(e);
  const SliceGrid grid = centered_grid({0.5, 0.5, 0.5}, {0.1, 0, 0}, {0, 0.1, 0}, 30, 14); // x −0.95 … 1.95
  const Slice slice = slicer.slice(grid, 1);
  for (int y = 0; y < 14; ++y)
    for (int x = 0; x + 10 < 30; ++x) {
      const double v = grid.at(x, y).y();
      EXPECT_EQ(slice.inside[slice.index(x, y)] != 0, v >= 0 && v <= 1);
      EXPECT_NEAR(slice.color.at(x, y)[0], slice.color.at(x + 10, y)[0], 1e-5); // one period on
      if (slice.inside[slice.index(x, y)]) {
        EXPECT_NEAR(slice.depth[slice.index(x, y)], v, 1e-6);
      }
    }
}

TEST(Windows, ShowOneCutOnBothSides) {
  // Where the model is the exemplar and the window's place in it is forced, both windows are one picture.
  Exemplar e = noise_exemplar(true);
  e.wrap = {Wrap::clamp, Wrap::clamp, Wrap::clamp, Wrap::clamp};
  const Root root(exact_model(e, 1));
  EXPECT_TRUE(varies_with_depth(root.model(), root.model().layer[0]));
  for (const SliceClass c : slice_classes) {
    const WindowSets sets = windows_of(root, root.model().layer[0], c, {.windows = 10});
    EXPECT_EQ(sets.model.size(), 10u);
    EXPECT_EQ(sets.split_axis, -1);
    EXPECT_GT(sets.pixels_left, sets.pixels / 2);
    for (std::size_t i = 0; i < sets.model.size(); ++i)
      for (std::size_t p = 0; p < sets.model[i].inside.size(); ++p) {
        if (!sets.model[i].inside[p]) continue;
        EXPECT_NEAR(sets.model[i].depth[p], sets.exemplar[i].depth[p], 1e-4);
        for (int k = 0; k < 3; ++k)
          EXPECT_NEAR(sets.model[i].color.pixel[3 * p + k], sets.exemplar[i].color.pixel[3 * p + k], 2e-3);
      }
  }
}

TEST(Windows, LeaveOutPixelsWhereTheFrameHasTurned) {
  Model model = exact_model(noise_exemplar(false), 2);
  const Mat3d turned = Eigen::AngleAxisd(1, Vec3d::UnitZ()).toRotationMatrix();
  for (const TetId t : all_ids<TetId>(model.mesh.tet_count()))
    if (barycenter(model.mesh, t).x() > side / 2) model.field.axes[t] = turned;
  const Root root(std::move(model));
  const WindowSets sets = windows_of(root, root.model().layer[0], SliceClass::across_t, {.windows = 40});
  std::size_t mixed = 0;
  for (const Slice& s : sets.model) {
    bool left = false, right = false;
    for (std::size_t p = 0; p < s.inside.size(); ++p)
      if (s.inside[p]) (barycenter(root.model().mesh, s.source[p].tet).x() > side / 2 ? right : left) = true;
    mixed += left && right;
  }
  EXPECT_EQ(mixed, 0u);
  EXPECT_LT(sets.pixels_left, sets.pixels);
}

TEST(Windows, LeaveOutPixelsThatLayersAboveCover) {
  for (const float veil : {1.0f, 0.1f}) {
    Model model = exact_model(noise_exemplar(false), 2);
    Layer above = solid_layer(model, side, 1);
    above.exemplar = {constant("seed", 3, {255, 0, 0})};
    for (const TetId t : all_ids<TetId>(model.mesh.tet_count()))
      for (const std::uint32_t row : above.lookup[t.value].corner)
        above.corner[std::size_t(row) * 4 + 3] = barycenter(model.mesh, t).x() > side / 2 ? veil : 0.0f;
    model.layer.push_back(std::move(above));
    const Root root(std::move(model));
    const WindowSets sets = windows_of(root, root.model().layer[0], SliceClass::across_t, {.windows = 40});
    std::size_t free = 0;
    for (const Slice& s : sets.model)
      for (std::size_t p = 0; p < s.inside.size(); ++p) {
        if (!s.inside[p]) continue;
        ++free;
        ASSERT_LT(barycenter(root.model().mesh, s.source[p].tet).x(), side / 2) << veil;
      }
    EXPECT_GT(free, sets.pixels / 4) << veil;
    EXPECT_EQ(free, sets.pixels_left);
  }
}

TEST(SliceMetric, OfTheExemplarItselfIsAboutOneAndGrowsWithBlur) {
  for (const bool depth : {false, true}) {
    const Exemplar sharp = noise_exemplar(depth);
    const Root exact(exact_model(sharp, depth ? 1 : 2));
    SliceMetricOptions options;
    options.distance.patches = 2048;
    const SliceMetric good = slice_metric(exact, exact.model().layer[0], SliceClass::oblique, options);
    EXPECT_GT(good.pixels_left, 0.4);
    EXPECT_NEAR(good.relative.coherence, 1, 0.2) << depth;
    EXPECT_NEAR(good.relative.completeness, 1, 0.2) << depth;
    EXPECT_LT(good.relative.wasserstein, 1.5) << depth;
    // The same model filled with a blurred copy, told that its exemplar is the sharp one.
    Exemplar soft = sharp;
    for (int z = 0; z < 32; ++z)
      for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
          for (int c = 0; c < 3; ++c) {
            int sum = 0;
            for (int k = -4; k <= 4; ++k)
              for (int j = -4; j <= 4; ++j) sum += sharp.at((x + k + 32) % 32, y, (z + j + 32) % 32)[c];
            soft.at(x, y, z)[c] = std::uint8_t(sum / 81);
          }
    Model blurred_model = exact_model(sharp, depth ? 1 : 2);
    blurred_model.layer[0].exemplar.push_back(soft);
    blurred_model.layer[0].patch[0].exemplar = 1;
    const Root blurred_root(std::move(blurred_model));
    const SliceMetric bad = slice_metric(blurred_root, blurred_root.model().layer[0], SliceClass::oblique, options);
    EXPECT_GT(bad.relative.wasserstein, 1.2 * good.relative.wasserstein) << depth;
    EXPECT_GT(bad.relative.color, 1.5 * good.relative.color) << depth;
    EXPECT_GT(bad.relative.autocorrelation, 1.5 * good.relative.autocorrelation) << depth;
  }
}

TEST(NearAxis, FindsATextureThatIsSpoiltAtTheAxisOnly) {
  const Exemplar sharp = noise_exemplar(false);
  const std::vector<Vec3d> axis{{5, 5, 0}, {5, 5, 10}};
  const auto with_flat_core = [&](bool flat) {
    Model model = exact_model(sharp, 2, 16);
    Layer& layer = model.layer[0];
    layer.exemplar.push_back(constant("grey", 3, {128, 128, 128}));
    layer.patch.resize(2);
    layer.patch[1].exemplar = 1;
    if (flat)
      for (const TetId t : all_ids<TetId>(model.mesh.tet_count()))
        if ((barycenter(model.mesh, t) - Vec3d(5, 5, 0)).head<2>().norm() < 1.2) layer.lookup[t].patch = 1;
    return Root(std::move(model));
  };
  SliceMetricOptions options;
  options.window.windows = 64;
  options.distance.patches = 2048;
  const Root good = with_flat_core(false), bad = with_flat_core(true);
  const auto same = near_axis_measure(good, good.model().layer[0], axis, options, 0.1);
  const auto spoilt = near_axis_measure(bad, bad.model().layer[0], axis, options, 0.1);
  ASSERT_TRUE(same && spoilt);
  EXPECT_NEAR(same->reach, 1, 1e-9);
  EXPECT_NEAR(same->ratio.coherence, 1, 0.3);
  EXPECT_GT(spoilt->ratio.wasserstein, 1.3 * same->ratio.wasserstein);
  EXPECT_GT(spoilt->ratio.color, 2 * same->ratio.color);
  EXPECT_FALSE(near_axis_measure(good, good.model().layer[0], {}, options));
}

/// Pictures of two patches side by side, right half with source 1, with or without a step or a mixed band between.
Slice two_patches(std::uint64_t seed, float step, int band) {
  Slice s = slice_of(64, 64), right = slice_of(64, 64);
  for (std::size_t i = 0; i < s.color.pixel.size(); ++i) { // white noise: neighbours are independent
    s.color.pixel[i] = linear_from_srgb(float(0.3 + 0.2 * unit_double(hash_of(seed, i))));
    right.color.pixel[i] = linear_from_srgb(float(0.3 + step + 0.2 * unit_double(hash_of(seed, i, 1))));
  }
  s.source.resize(64 * 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const bool mixed = std::abs(x - 31.5) < band;
      PixelSource& source = s.source[s.index(x, y)];
      source.layer = 0;
      source.patch = x >= 32;
      source.share = mixed ? 0.5f : 1;
      for (int c = 0; c < 3; ++c) {
        float& v = s.color.at(x, y)[c];
        const float other = right.color.at(x, y)[c];
        if (mixed) {
          v = linear_from_srgb(0.5f * (srgb_from_linear(v) + srgb_from_linear(other)));
        } else if (x >= 32) {
          v = other;
        }
      }
    }
  return s;
}

TEST(Seams, AreNoneWherePatchesMeetWithoutATrace) {
  std::vector<Slice> slices;
  for (int i = 0; i < 20; ++i) slices.push_back(two_patches(i, 0, 0));
  const SeamMeasure m = seam_measure(slices);
  EXPECT_EQ(m.border_pairs, 20u * 64);
  EXPECT_EQ(m.border_share, 0);
  EXPECT_NEAR(m.border_gradient_p99, 1, 0.05);
  EXPECT_EQ(m.band_gradient, 1);
  EXPECT_EQ(m.band_variance, 1);
  slices[0].source.clear();
  EXPECT_THROW(seam_measure(slices), InvalidInput);
}

TEST(Seams, APlantedStepIsFoundAndGrows) {
  double last = 1.05;
  for (const float step : {0.1f, 0.2f, 0.4f}) {
    std::vector<Slice> slices;
    for (int i = 0; i < 10; ++i) slices.push_back(two_patches(i, step, 0));
    const SeamMeasure m = seam_measure(slices);
    EXPECT_GT(m.border_gradient_p99, 1.1 * last) << step;
    last = m.border_gradient_p99;
  }
}

TEST(Seams, MixingTwoUnlikePatchesHalvesTheVariance) {
  std::vector<Slice> slices;
  for (int i = 0; i < 10; ++i) slices.push_back(two_patches(i, 0, 8));
  const SeamMeasure m = seam_measure(slices);
  EXPECT_NEAR(m.border_share, 0.25, 1e-6);
  EXPECT_NEAR(m.band_variance, 0.5, 0.05);
  EXPECT_NEAR(m.band_gradient, std::sqrt(0.5), 0.05);
}

/// Green with dark balls, two along each axis of the exemplar.
Exemplar ball_exemplar(int size = 32) {
  return exemplar_of("balls", 3, {size, size, size}, Wrap::repeat, linear_color(), [=](int x, int y, int z) {
    const Vec3d p = (Vec3d(x, y, z) + Vec3d::Constant(0.5)) / size;
    const Vec3d d(std::fmod(2 * p.x(), 1) - 0.5, std::fmod(2 * p.y(), 1) - 0.5, std::fmod(2 * p.z(), 1) - 0.5);
    return d.norm() < 0.3 ? std::vector<int>{5, 5, 5} : std::vector<int>{60, 200, 60};
  });
}

TEST(Objects, OfAnExemplarAreFoundAcrossItsFaces) {
  const Exemplar e = ball_exemplar();
  const auto rule = object_rule_of(e);
  ASSERT_TRUE(rule);
  EXPECT_LT(rule->color.norm(), 0.5f); // the dark ones
  // The surface lies where the colour is half one, half the other, by the light.
  const ObjectRule half{Vec3f::Constant(srgb_from_linear(5 / 255.0f)), 0.62f};
  EXPECT_EQ(exemplar_objects(e, *rule, 64).size(), 8u);
  const auto objects = exemplar_objects(e, half, 64);
  EXPECT_EQ(objects.size(), 8u);
  for (const FoundObject& o : objects) {
    EXPECT_FALSE(o.clipped);
    EXPECT_NEAR(o.volume, 4.0 / 3 * std::numbers::pi * std::pow(0.15, 3), 0.2 * 0.0141);
    for (const double s : o.spread) EXPECT_NEAR(s, 0.15 / std::sqrt(5), 0.1 * 0.067); // a ball's second moment
  }
  Exemplar moved = e; // half a ball at either end of x
  for (int z = 0; z < 32; ++z)
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x)
        for (int c = 0; c < 3; ++c) moved.at(x, y, z)[c] = e.at((x + 8) % 32, y, z)[c];
  EXPECT_EQ(exemplar_objects(moved, *rule, 64).size(), 8u);
  moved.wrap[0] = Wrap::clamp;
  const auto cut = exemplar_objects(moved, *rule, 64);
  EXPECT_EQ(std::count_if(cut.begin(), cut.end(), [](auto& o) { return o.clipped; }), 8);
  EXPECT_FALSE(object_rule_of(noise_exemplar(true)));
}

TEST(Objects, AreWholeInAWholeSolidAndAPlantedHalfIsFound) {
  const ObjectRule rule{Vec3f(0.15f, 0.15f, 0.15f), 0.3f};
  Model model = exact_model(ball_exemplar(), 2, 8);
  const Root whole(model);
  const auto all = object_measure(whole, whole.model().layer[0], rule, {.voxels = 500'000});
  ASSERT_TRUE(all);
  EXPECT_EQ(all->exemplar_objects, 8u);
  EXPECT_EQ(all->objects, 64u);
  EXPECT_EQ(all->whole, 64u);
  EXPECT_EQ(all->clipped, 0u);
  EXPECT_NEAR(all->median_volume, 1, 0.1);
  // Beyond x = 3.75 (through the middle of 16 balls) the patch is moved by half a ball's distance: halves remain.
  Layer& layer = model.layer[0];
  layer.patch.resize(2);
  layer.patch[1].frame.offset[0] = 0.25f;
  layer.patch[1].frame.offset[1] = 0.25f;
  for (const TetId t : all_ids<TetId>(model.mesh.tet_count()))
    if (barycenter(model.mesh, t).x() > 3.75) layer.lookup[t].patch = 1;
  const Root cut(std::move(model));
  const auto some = object_measure(cut, cut.model().layer[0], rule, {.voxels = 500'000});
  ASSERT_TRUE(some);
  EXPECT_GE(some->too_small + some->misshapen, 16u);
  EXPECT_LT(some->whole, some->objects);
  EXPECT_NEAR(some->first_broken.x(), 3.75, 1.0);
}

} // namespace
} // namespace pith
