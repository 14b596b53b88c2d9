// Fills from volumes that pith did not make: scans (PITH_SHARED_DATA), and solids whose statistics are known in
// closed form. None of them repeats by itself; recipes ask for that ("tile").
#include "recipe/build.h"
#include "tests/support/scratch.h"
#include "tests/support/shared_data.h"
#include "tests/support/tri_shapes.h"
#include "volume/base/error.h"
#include "volume/base/random.h"
#include "volume/io/exemplar_io.h"
#include "volume/io/mesh_io.h"
#include "volume/measure/slice_metric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

namespace pith {
namespace {

using testing::ScratchFolder;

constexpr double radius = 30, scale = 25; // mm: of the ball that is filled, and of a texture width

class Foreign : public ::testing::Test {
protected:
  /// The ball, filled with an exemplar file.
  Root filled(const std::string& file, const std::string& solid) {
    write_tri_mesh(folder / "ball.obj", testing::sphere_surface(4, radius));
    const Recipe recipe = parse_recipe(R"({"pith": 1, "surface": {"file": "ball.obj"},
      "tetrahedralize": {"interior_edge": 4}, "solids": [{)" +
                                           solid + R"(, "scale": 25, "exemplar": {"file": ")" + file +
                                           R"(", "tile": {"along": "RST"}}}]})",
                                       "ball.json");
    return Root(Builder().build(recipe, folder.path()).model, {.mips = false});
  }
  /// Slices are as like the exemplar as its one half is like the other, within a bar. Of one set of windows the
  /// ratio is a sample that strays (docs/quality.md), so four sets are added up; and of the Wasserstein distance,
  /// which strays by 0.3 even so, all classes together are held to the bar.
  static void expect_alike(const Root& root, double bar) {
    TextureDistance shown, own;
    for (const SliceClass c : slice_classes) {
      TextureDistance class_shown, class_own;
      for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SliceMetricOptions options;
        options.window.seed = options.distance.seed = seed;
        const SliceMetric m = slice_metric(root, root.model().layer.front(), c, options);
        ASSERT_GT(m.relative.patches, 0u);
        class_shown.coherence += m.distance.coherence, class_own.coherence += m.self.coherence;
        class_shown.wasserstein += m.distance.wasserstein, class_own.wasserstein += m.self.wasserstein;
      }
      std::cout << "  class " << int(c) << ": coherence " << class_shown.coherence / class_own.coherence
                << ", sliced Wasserstein " << class_shown.wasserstein / class_own.wasserstein << '\n';
      EXPECT_LE(class_shown.coherence, bar * class_own.coherence) << "class " << int(c);
      shown.wasserstein += class_shown.wasserstein, own.wasserstein += class_own.wasserstein;
    }
    std::cout << "  all: sliced Wasserstein " << shown.wasserstein / own.wasserstein << '\n';
    EXPECT_LE(shown.wasserstein, bar * own.wasserstein);
  }
  /// A grey value per texel, 0 … 1, as a file.
  void write_grey(const std::string& name, int n, const std::vector<double>& value) {
    Exemplar e;
    e.name = "grey";
    e.size = {n, n, n, 1};
    e.channel = {Channel{"color", Semantic::color, 3, false, 0, 1}};
    for (const double v : value)
      for (int c = 0; c < 3; ++c) e.texel.push_back(encoded(e.channel[0], static_cast<float>(v)));
    write_exemplar(folder / name, e);
  }
  static double grey_at(const Root& root, const Vec3d& x) {
    MaterialPoint point;
    point.position = x;
    return material_at(root, point).value[0];
  }
  /// A random point at least `clear` mm inside the ball.
  static Vec3d inner_point(Random& random, double clear) {
    for (;;) {
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
      const Vec3d p = radius * Vec3d(x, y, z);
      if (p.norm() < 0.98 * radius - clear) return p;
    }
  }
  ScratchFolder folder;
};

TEST_F(Foreign, TilingIsPartOfTheRecipeAndOfItsStages) {
  write_tri_mesh(folder / "ball.obj", testing::sphere_surface(2, radius));
  std::vector<double> ramp;
  for (int i = 0; i < 16 * 16 * 16; ++i) ramp.push_back(i % 16 / 16.0);
  write_grey("ramp.exemplar", 16, ramp);
  Recipe recipe =
      parse_recipe(R"({"pith": 1, "surface": {"file": "ball.obj"}, "tetrahedralize": {"interior_edge": 10},
    "solids": [{"type": "0", "scale": 25, "exemplar": {"file": "ramp.exemplar", "tile": {"border": 0.25}}}]})",
                   "ball.json");
  const std::string text = recipe_text(recipe);
  const Recipe again = parse_recipe(text, "ball.json");
  ASSERT_TRUE(again.solids[0].exemplar.tile);
  EXPECT_EQ(again.solids[0].exemplar.tile->border, 0.25);
  EXPECT_EQ(again.solids[0].exemplar.tile->axis, (std::array<bool, 3>{true, true, true}));
  EXPECT_EQ(recipe_text(again), text);
  Builder builder;
  EXPECT_EQ(builder.build(recipe, folder.path()).model.layer[0].exemplar[0].size[0], 12);
  recipe.solids[0].exemplar.tile->border = 0.5;
  EXPECT_EQ(builder.build(recipe, folder.path()).model.layer[0].exemplar[0].size[0], 8);
  recipe.solids[0].exemplar.tile.reset();
  EXPECT_THROW(builder.build(recipe, folder.path()), InvalidInput) << "it does not repeat by itself";
}

TEST_F(Foreign, ACementScanFillsABall) {
  PITH_REQUIRE_SHARED(scan, "volumes/cement_128.tif");
  std::filesystem::copy_file(scan, folder / "cement.tif");
  const Root root = filled("cement.tif", R"("type": "0")");
  EXPECT_EQ(root.model().layer.front().exemplar.front().size, (std::array<int, 4>{96, 96, 96, 1}));
  expect_alike(root, 1.3);
}

TEST_F(Foreign, ACarbonFibreScanFillsABall) {
  PITH_REQUIRE_SHARED(scan, "volumes/carbon_fibre_100.tif");
  std::filesystem::copy_file(scan, folder / "carbon.tif");
  expect_alike(filled("carbon.tif", R"("type": "1-a", "orientation": [{"stroke": [[0, 0, -25], [0, 0, 25]]}])"), 1.3);
}

/// Balls at random places, free to overlap (a Boolean model): the share of space that they leave is exp(−ρ 4π r³/3),
/// and chords in it are exponential with mean 1/(ρ π r²).
TEST_F(Foreign, OverlappingBallsKeepTheirShareAndTheirChords) {
  constexpr int n = 96;
  constexpr double r = 0.055, empty = 0.7;
  const double rho = -std::log(empty) / (4 * std::numbers::pi / 3 * r * r * r);
  Random random(11);
  std::vector<double> value(n * n * n, 0.0);
  // As many as a Poisson process has on average in the cube and a margin around it.
  const double side = 1 + 2 * r;
  for (int ball = 0; ball < std::lround(rho * side * side * side); ++ball) {
    const double x = random.uniform(-r, 1 + r), y = random.uniform(-r, 1 + r), z = random.uniform(-r, 1 + r);
    const Vec3d c(x, y, z);
    const auto low = [&](int a) { return std::max(0, int((c[a] - r) * n) - 1); };
    const auto high = [&](int a) { return std::min(n - 1, int((c[a] + r) * n) + 1); };
    for (int k = low(2); k <= high(2); ++k)
      for (int j = low(1); j <= high(1); ++j)
        for (int i = low(0); i <= high(0); ++i) {
          const double d = ((Vec3d(i, j, k) + Vec3d::Constant(0.5)) / n - c).norm();
          double& v = value[(k * n + j) * n + i];
          v = std::max(v, std::clamp((r - d) * n + 0.5, 0.0, 1.0));
        }
  }
  write_grey("balls.exemplar", n, value);
  const Root root = filled("balls.exemplar", R"("type": "0", "mask": {"drop_off": 0.02})");

  constexpr double step = 0.004 * scale;
  std::size_t left = 0, points = 0, borders = 0;
  for (int line = 0; line < 600; ++line) {
    const Vec3d a = inner_point(random, 0), b = inner_point(random, 0);
    const int count = static_cast<int>((b - a).norm() / step);
    bool before = false;
    for (int i = 0; i < count; ++i) {
      const bool ball = grey_at(root, a + step * i * (b - a).normalized()) > 0.5;
      left += !ball;
      ++points;
      borders += i > 0 && ball != before;
      before = ball;
    }
  }
  const Exemplar& exemplar = root.model().layer.front().exemplar.front();
  double own = 0;
  for (std::size_t i = 0; i < exemplar.texel.size(); i += 3) own += exemplar.texel[i] < 128;
  own /= double(exemplar.texel_count());
  // A texture width is what is left of the cube after tiling.
  const double unit = scale * n / exemplar.size[0];
  const double share = double(left) / double(points), chord = 2 * double(left) * step / double(borders) / unit;
  std::cout << "  share " << share << " (exemplar: " << own << ") of " << empty << ", mean chord " << chord << " of "
            << 1 / (rho * std::numbers::pi * r * r) << '\n';
  EXPECT_NEAR(share / empty, 1, 0.1);
  EXPECT_NEAR(chord * rho * std::numbers::pi * r * r, 1, 0.15);
  expect_alike(root, 1.3);
}

/// White noise under a Gaussian of σ: correlated like exp(−h²/4σ²) at distance h, here farther along T than across.
TEST_F(Foreign, FilteredNoiseKeepsItsCorrelation) {
  constexpr int n = 96, margin = 24, m = n + 2 * margin;
  const std::array<double, 3> sigma{1.6, 1.6, 3.2}; // texels
  std::vector<float> field(std::size_t(m) * m * m);
  Random random(12);
  for (float& v : field) v = static_cast<float>(random.normal());
  std::size_t stride = 1;
  for (int axis = 0; axis < 3; ++axis, stride *= m) {
    const int reach = static_cast<int>(std::ceil(4 * sigma[axis]));
    std::vector<double> weight;
    double squares = 0;
    for (int k = -reach; k <= reach; ++k) {
      weight.push_back(std::exp(-0.5 * k * k / sigma[axis] / sigma[axis]));
      squares += weight.back() * weight.back();
    }
    std::vector<float> next(field.size());
    for (std::size_t i = reach * stride; i + reach * stride < field.size(); ++i) {
      double sum = 0;
      for (int k = -reach; k <= reach; ++k) sum += weight[k + reach] * field[i + k * std::ptrdiff_t(stride)];
      next[i] = static_cast<float>(sum / std::sqrt(squares)); // variance 1
    }
    field.swap(next);
  }
  std::vector<double> value;
  for (int z = margin; z < margin + n; ++z)
    for (int y = margin; y < margin + n; ++y)
      for (int x = margin; x < margin + n; ++x)
        value.push_back(std::clamp(0.5 + 0.15 * field[(std::size_t(z) * m + y) * m + x], 0.0, 1.0));
  write_grey("noise.exemplar", n, value);
  const Root root =
      filled("noise.exemplar", R"("type": "1-a", "orientation": [{"stroke": [[0, 0, -25], [0, 0, 25]]}])");

  // What is left after tiling is three quarters of a width as long as the whole.
  const double texel = scale / root.model().layer.front().exemplar.front().size[0];
  for (const int axis : {0, 1, 2}) {
    const double lag = 2 * sigma[axis] * texel; // where exp(−1) is expected
    double sum = 0, squares = 0, products = 0;
    constexpr int pairs = 30'000;
    for (int i = 0; i < pairs; ++i) {
      const Vec3d x = inner_point(random, lag);
      const double a = grey_at(root, x), b = grey_at(root, x + lag * Vec3d::Unit(axis));
      sum += a + b, squares += a * a + b * b, products += a * b;
    }
    const double mean = sum / (2 * pairs), variance = squares / (2 * pairs) - mean * mean;
    const double correlation = (products / pairs - mean * mean) / variance;
    std::cout << "  axis " << axis << ": correlation " << correlation << " of " << std::exp(-1.0) << ", deviation "
              << std::sqrt(variance) << " of 0.15\n";
    EXPECT_NEAR(correlation, std::exp(-1.0), 0.1);
    EXPECT_NEAR(mean, 0.5, 0.02);
    EXPECT_GT(std::sqrt(variance), 0.8 * 0.15); // patches that mix lose some
    EXPECT_LT(std::sqrt(variance), 1.05 * 0.15);
  }
  expect_alike(root, 1.3);
}

} // namespace
} // namespace pith
