#include "raytrace/render.h"

#include "raytrace/framing.h"
#include "raytrace/sampling.h"
#include "raytrace/tone.h"
#include "tests/raytrace/scenes.h"
#include "volume/base/error.h"
#include "volume/cut/cut.h"

#include <cstring>
#include <gtest/gtest.h>

namespace pith {
namespace {

using testing::colorful;
using testing::constant_sky;
using testing::Estimate;
using testing::matte;
using testing::over_seeds;
using testing::root_of;

constexpr double pi = std::numbers::pi;

/// True when the estimate agrees with `expected` to four standard errors, and the error is small enough to mean
/// something.
::testing::AssertionResult agrees(const Estimate& estimate, double expected, double largest_error) {
  const double off = std::abs(estimate.mean - expected);
  if (estimate.error > largest_error)
    return ::testing::AssertionFailure() << "standard error " << estimate.error << " is too large to tell";
  if (off > 4 * estimate.error + 1e-9)
    return ::testing::AssertionFailure() << estimate.mean << " ± " << estimate.error << " is not " << expected;
  return ::testing::AssertionSuccess();
}

double mean_color(const Film& film, int channel = 0) {
  double sum = 0;
  for (const FilmPixel& p : film.pixel) sum += p.color[channel] / p.samples;
  return sum / film.pixel.size();
}

/// A view of a small patch around a point, along −normal.
View close_up(const Vec3d& at, const Vec3d& from, double size) {
  View view;
  view.eye = from;
  view.target = at;
  view.up = (from - at).normalized().unitOrthogonal();
  view.vertical_angle = 0;
  view.height = size;
  return view;
}

RenderOptions small(int pixels, int samples, std::uint64_t seed) {
  RenderOptions options;
  options.width = options.height = pixels;
  options.samples = samples;
  options.seed = seed;
  options.background.kind = Background::Kind::sky;
  return options;
}

class Furnace : public ::testing::TestWithParam<double> {}; // refractive index of the coat

/// A white body in constant light is not to be seen.
TEST_P(Furnace, WhiteBallVanishes) {
  const Root root = root_of(tet_ball(14, 20), Vec3d::Ones());
  SceneOptions options = matte();
  options.skin = {.roughness = 0.4, .index = GetParam()};
  const Scene scene(root, whole_piece(root.model().mesh), options);
  const View view = framed_view(scene, {.aspect = 1, .margin = 0.3});
  const Estimate seen = over_seeds(6, [&](std::uint64_t seed) {
    RenderOptions render_options = small(24, 32, seed);
    render_options.max_depth = 12;
    return mean_color(render(scene, view, constant_sky(1), render_options));
  });
  EXPECT_NEAR(seen.mean, 1, 4 * seen.error + (GetParam() > 1 ? 3e-3 : 1e-9)); // 3e-3: the coat's table
  EXPECT_LT(seen.error, 1e-3);
}
INSTANTIATE_TEST_SUITE_P(Index, Furnace, ::testing::Values(1.0, 1.4, 1.8));

TEST(Render, MatteBoxUnderAConstantSkyShowsItsAlbedoTimesTheSky) {
  const Root root = root_of(tet_grid(2, 2, 2, 10), Vec3d(0.2, 0.4, 0.6));
  const Scene scene(root, whole_piece(root.model().mesh), matte());
  // Convex and flat: each point sees half the sky, E = π L, radiance = albedo · L. Albedo is a byte over 255.
  const Estimate seen = over_seeds(8, [&](std::uint64_t seed) {
    return mean_color(render(scene, close_up({10, 10, 20}, {14, 3, 50}, 4), constant_sky(2.5), small(4, 16, seed)),
                      1);
  });
  EXPECT_TRUE(agrees(seen, 2.5 * 102 / 255.0, 4e-3));
}

TEST(Render, GroundUnderADirectedSkyShowsItsIrradiance) {
  // Radiance a + b·s with s = 1 − (1 − cos θ)²: E = π a + 2π b ∫ (2c − c²) c dc = π (a + 5/6 b).
  const Root root = root_of(tet_grid(1, 1, 1, 1), Vec3d(0.5, 0.5, 0.5));
  SceneOptions options = matte();
  options.ground.on = true;
  options.ground.albedo = {0.8, 0.8, 0.8};
  options.ground.fade_begin = 1000, options.ground.fade_end = 2000;
  const Scene scene(root, whole_piece(root.model().mesh), options);
  Lights lights = constant_sky(0.4);
  lights.environment.zenith = Vec3d::Constant(1.9);
  const Estimate seen = over_seeds(8, [&](std::uint64_t seed) {
    return mean_color(render(scene, close_up({60, 0, 0}, {80, 40, 10}, 1), lights, small(4, 32, seed)));
  });
  EXPECT_TRUE(agrees(seen, 0.8 * (0.4 + 1.5 * 5 / 6), 2e-3));
}

/// Irradiance below the corner of a rectangle a × b at height h (Lambert's formula; Howell's view factor C-11).
double corner_factor(double a, double b, double h) {
  const double x = a / h, y = b / h, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * pi);
}

TEST(Render, AreaLightOverAPlaneMatchesTheViewFactor) {
  const Root root = root_of(tet_grid(2, 1, 2, 50), Vec3d(0.6, 0.6, 0.6));
  const Scene scene(root, whole_piece(root.model().mesh), matte());
  Lights lights = constant_sky(0);
  AreaLight light;
  light.edge_u = {30, 0, 0}, light.edge_v = {0, 0, 40}; // x × z = −y: down
  light.radiance = {7, 7, 7};
  const Vec3d at(50, 50, 50);
  const double a = 30, b = 40, h = 25;
  light.center = at + Vec3d(a / 2, h, b / 2); // a corner right above the point
  lights.area.push_back(light);
  // Two estimators in one: next event sampling for the matte surface, and its weighted partner.
  const Estimate seen = over_seeds(10, [&](std::uint64_t seed) {
    return mean_color(render(scene, close_up(at, {20, 70, 50}, 1e-3), lights, small(4, 32, seed)));
  });
  EXPECT_TRUE(agrees(seen, 153 / 255.0 * 7 * corner_factor(a, b, h), 2e-3));

  // From behind the light shines nowhere.
  lights.area[0].edge_u *= -1;
  EXPECT_EQ(mean_color(render(scene, close_up(at, {20, 70, 50}, 1e-3), lights, small(4, 8, 1))), 0);
}

TEST(Render, HalfTheAreaLightHiddenIsHalfTheLight) {
  // A wall on the ground hides exactly one half of a light from points in its plane.
  TetMesh wall = tet_grid(1, 4, 4, 10);
  const Root root = root_of(std::move(wall), Vec3d::Zero());
  SceneOptions options = matte();
  options.ground.on = true;
  options.ground.fade_begin = 1000, options.ground.fade_end = 2000;
  options.ground.albedo = Vec3d::Constant(0.5);
  const Scene scene(root, whole_piece(root.model().mesh), options);
  Lights lights = constant_sky(0);
  AreaLight light;
  light.center = {0, 30, 20};
  light.edge_u = {10, 0, 0}, light.edge_v = {0, 0, 10};
  light.radiance = {9, 9, 9};
  lights.area.push_back(light);
  // The point lies on the face x = 0 of the wall (0 … 10), just in front of its foot.
  const auto radiance = [&](const Scene& in, std::uint64_t seed) {
    RenderOptions o = small(2, 64, seed);
    o.max_depth = 1;
    return mean_color(render(in, close_up({-0.001, 0, 20}, {-50, 30, 20}, 1e-5), lights, o));
  };
  SceneOptions empty = options;
  empty.ground.height = 0;
  Pieces away = whole_piece(root.model().mesh);
  away.piece[0].placement.translation = {500, 0, 0};
  const Scene open(root, away, empty);
  const Estimate hidden =
      over_seeds(8, [&](std::uint64_t s) { return radiance(scene, s) - 0.5 * radiance(open, s); });
  const double whole = radiance(open, 1);
  EXPECT_GT(whole, 0.05);
  EXPECT_NEAR(hidden.mean / whole, 0, 0.01);
}

class Pictures : public ::testing::Test {
protected:
  Pictures() : root(root_of(tet_ball(8, 20), colorful())), pieces(whole_piece(root.model().mesh)) {}
  RenderOptions options(int samples, std::uint64_t seed = 1) const {
    RenderOptions o;
    o.width = 40, o.height = 30;
    o.samples = samples;
    o.seed = seed;
    return o;
  }
  void cut_by(const PlaneCut& plane) { cut(pieces, root.model().mesh, root.model().boundary, *level_set_of(plane)); }
  Film picture(const SceneOptions& scene_options, const RenderOptions& o) const {
    const Scene scene(root, pieces, scene_options);
    const View view = framed_view(scene, {.direction = {0.3, 0.4, 1}});
    return render(scene, view, default_lights(view, scene.bounds().center(), 25, {0, 1, 0}), o);
  }
  Root root;
  Pieces pieces;
};

TEST_F(Pictures, AreTheSameForAnyNumberOfThreadsAndRuns) {
  cut_by({{0.1, 1, 0.2}, 2});
  pieces.piece[1].placement.translation = {0, 12, 0};
  RenderOptions o = options(20);
  o.threads = 1;
  const Film one = picture({}, o);
  for (const int threads : {2, 2, 4}) {
    o.threads = threads;
    const Film many = picture({}, o);
    for (std::size_t i = 0; i < one.pixel.size(); ++i) {
      ASSERT_EQ(one.pixel[i].color, many.pixel[i].color);
      ASSERT_EQ(one.pixel[i].position, many.pixel[i].position);
      ASSERT_EQ(one.pixel[i].normal, many.pixel[i].normal);
      ASSERT_EQ(one.pixel[i].piece, many.pixel[i].piece);
    }
  }
}

TEST_F(Pictures, DependOnTheSeed) {
  EXPECT_NE(picture({}, options(2, 1)).at(20, 15).color, picture({}, options(2, 2)).at(20, 15).color);
}

TEST_F(Pictures, CuttingWithoutMovingChangesNothingButRounding) {
  const Film before = picture({}, options(16));
  cut_by({{0.1, 1, 0.2}, 2});
  cut_by({{1, 0.1, 0.4}, -3});
  ASSERT_EQ(pieces.piece.size(), 4u);
  const Film after = picture({}, options(16));
  // Paths are the same up to the rounding of hits; now and then one goes another way at an edge.
  int apart = 0;
  for (std::size_t i = 0; i < before.pixel.size(); ++i) {
    double difference = 0;
    for (int c = 0; c < 3; ++c) difference += std::abs(before.pixel[i].color[c] - after.pixel[i].color[c]) / 16;
    apart += difference > 1e-3;
  }
  EXPECT_LE(apart, int(before.pixel.size() / 100));
}

TEST_F(Pictures, ShowEachPieceTheColourOfItsRestPlace) {
  cut_by({{0, 1, 0}, 0});
  pieces.piece[1].placement.translation = {0, 35, 0};
  SceneOptions flat = matte();
  const Scene scene(root, pieces, flat);
  const View view = framed_view(scene, {.direction = {0, 0, 1}});
  const Film film = render(scene, view, constant_sky(1), options(8));
  int seen = 0;
  for (const FilmPixel& p : film.pixel) {
    // At rims a pixel's mean place is not where its colour comes from.
    if (p.hits != p.samples || p.normal[2] < 0.7f * p.samples) continue;
    const Vec3d world = Vec3d(p.position[0], p.position[1], p.position[2]) / p.hits;
    const Vec3d rest = pieces.piece[p.piece].placement.inverse(world);
    MaterialPoint point;
    point.position = rest;
    const Material expected = material_at(root, point);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(p.albedo[c] / p.samples, expected.value[c], 0.05);
    ++seen;
  }
  EXPECT_GT(seen, 60);
}

TEST_F(Pictures, HaveNoBadPixel) {
  cut_by({{0.1, 1, 0.2}, 2});
  pieces.piece[1].placement.translation = {4, 10, 3};
  for (const Background::Kind kind :
       {Background::Kind::backdrop, Background::Kind::sky, Background::Kind::color, Background::Kind::transparent}) {
    RenderOptions o = options(8);
    o.background.kind = kind;
    const Film film = picture({}, o);
    bool partly = false;
    for (const FilmPixel& p : film.pixel) {
      EXPECT_EQ(p.samples, 8u);
      for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(std::isfinite(p.color[c]) && p.color[c] >= 0);
        EXPECT_TRUE(std::isfinite(p.square[c]) && p.albedo[c] >= 0 && p.albedo[c] <= 1.0001f * p.samples);
      }
      EXPECT_TRUE(p.alpha >= 0 && p.alpha <= p.samples);
      partly |= p.alpha < p.samples;
    }
    EXPECT_EQ(partly, kind == Background::Kind::transparent);
    for (const FilmLayer& layer : layers_of(film)) {
      EXPECT_EQ(layer.channel.size(), std::size_t(layer.image.channels)) << layer.name;
      EXPECT_EQ(layer.image.width, film.width);
    }
  }
}

/// Facets may not show in the shadow's edge: in light from one side, a coarse ball looks like a round one.
TEST_F(Pictures, ShowNoShadowTerminatorOfFacets) {
  Lights lights = constant_sky(0);
  AreaLight light;
  const Vec3d place(-95, 20, -14); // no facets' edge runs along the terminator
  const LocalFrame back(-place.normalized());
  light.center = place;
  light.edge_u = back.tangent, light.edge_v = back.bitangent;
  light.radiance = Vec3d::Constant(1e4);
  lights.area.push_back(light);
  const Root white = root_of(tet_ball(4, 20), Vec3d::Ones());
  const Scene scene(white, whole_piece(white.model().mesh), matte());
  const View view = close_up({0, 0, 0}, {0, 0, 100}, 30);
  RenderOptions o = small(60, 16, 1);
  o.max_depth = 1;
  const Film film = render(scene, view, lights, o);
  int lit = 0, dark = 0;
  for (const FilmPixel& p : film.pixel) {
    if (p.hits != p.samples) continue;
    const Vec3d normal = Vec3d(p.normal[0], p.normal[1], p.normal[2]).normalized();
    const Vec3d at = Vec3d(p.position[0], p.position[1], p.position[2]) / p.hits;
    const Vec3d to = place - at;
    const double cosine = normal.dot(to.normalized());
    if (cosine < 0.05) continue;
    ++lit;
    const double expected = 1e4 / pi * cosine * to.normalized().dot(place.normalized()) / to.squaredNorm();
    const double ratio = p.color[0] / p.samples / expected;
    EXPECT_LT(ratio, 1.15);
    dark += ratio < 0.85;
  }
  EXPECT_GT(lit, 500);
  EXPECT_LT(dark, lit / 100) << "of " << lit;
}

TEST_F(Pictures, ContinueWhereTheyStopped) {
  const Film whole = picture({}, options(24));
  Film first = picture({}, options(10));
  RenderOptions rest = options(14);
  rest.first_sample = 10;
  merge(first, picture({}, rest));
  for (std::size_t i = 0; i < whole.pixel.size(); ++i) {
    EXPECT_EQ(whole.pixel[i].samples, first.pixel[i].samples);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(whole.pixel[i].color[c], first.pixel[i].color[c], 1e-9 * (1 + whole.pixel[i].color[c]));
    EXPECT_EQ(whole.pixel[i].piece, first.pixel[i].piece);
  }
  EXPECT_THROW(merge(first, Film(3, 3)), InvalidInput);
}

TEST_F(Pictures, StopWhenAsked) {
  const Scene scene(root, pieces);
  const View view = framed_view(scene);
  EXPECT_THROW(render(scene, view, constant_sky(1), options(64), [](double f) { return f < 0.3; }), Cancelled);
  RenderOptions o = options(100000);
  o.time_limit = 0.05;
  const Film film = render(scene, view, constant_sky(1), o);
  EXPECT_LT(film.at(0, 0).samples, 100000u);
  for (const FilmPixel& p : film.pixel) EXPECT_EQ(p.samples, film.at(0, 0).samples);
}

TEST_F(Pictures, RefuseOptionsOutOfRange) {
  const Scene scene(root, pieces);
  const View view = framed_view(scene);
  RenderOptions o = options(0);
  EXPECT_THROW(render(scene, view, constant_sky(1), o), InvalidInput);
  o = options(1);
  o.width = 0;
  EXPECT_THROW(render(scene, view, constant_sky(1), o), InvalidInput);
  View blind = view;
  blind.target = blind.eye;
  EXPECT_THROW(render(scene, blind, constant_sky(1), options(1)), InvalidInput);
}

TEST(Tone, KeepsColoursAndRollsOffHighlights) {
  Image image(3, 1, 4);
  const float in[12] = {0.2f, 0.5f, 0.1f, 1, 5, 4, 3, 1, std::nanf(""), -1, 0.3f, 0.5f};
  std::copy(in, in + 12, image.pixel.begin());
  const Image out = tone_mapped(image);
  for (int c = 0; c < 4; ++c) EXPECT_EQ(out.at(0, 0)[c], in[c]);
  for (int c = 0; c < 3; ++c) EXPECT_TRUE(out.at(1, 0)[c] > 0.7f && out.at(1, 0)[c] < 1);
  EXPECT_GT(out.at(1, 0)[0], out.at(1, 0)[2]);
  EXPECT_EQ(out.at(2, 0)[0], 0);
  EXPECT_EQ(out.at(2, 0)[1], 0);
  EXPECT_EQ(out.at(2, 0)[3], 0.5f);
  EXPECT_NEAR(tone_mapped(image, {.exposure = -1}).at(0, 0)[0], 0.1f, 1e-6);
  EXPECT_EQ(tone_mapped(image, {.curve = ToneOptions::Curve::clip}).at(1, 0)[1], 1);
}

} // namespace
} // namespace pith
