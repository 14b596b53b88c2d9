// The proof that one layer carries all five methods: layers in the shape of each, colours in closed form.
#include "tests/layer/five_models.h"

#include "volume/layer/composite.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pith {
namespace {

using namespace testing;

Material inside(const Root& root, const Vec3d& x) { return material_at(root, {x, -1, {}, {}}); }

/// A random point of a boundary facet, and its barycentrics.
std::pair<Vec3d, std::array<double, 3>> facet_point(const Model& model, FacetId f, Random& random) {
  std::array<double, 3> b{random.uniform(), random.uniform(), 0};
  if (b[0] + b[1] > 1) b = {1 - b[0], 1 - b[1], 0};
  b[2] = 1 - b[0] - b[1];
  Vec3d x = Vec3d::Zero();
  for (int i = 0; i < 3; ++i) x += b[i] * model.mesh.position[model.boundary.corner[f][i]];
  return {x, b};
}

// Takayama 2008: many masked volumes over one another.
TEST(FiveMethods, ManyMaskedVolumesOverOneAnother) {
  const Root root(masked_volumes());
  for (const Vec3d& x : random_points(size, 2000, 1)) {
    const Vec3d u = x / size;
    const double ramp = std::clamp(15 * (18 * u.y() - 0.5), 0.0, 255.0) / 255;
    const double red = 51 / 255.0, blue = std::clamp((4 * u.x() - 0.5) / 3, 0.0, 1.0);
    const std::array<double, 3> expected{(1 - blue) * (red * 1 + (1 - red) * ramp), (1 - blue) * (1 - red) * ramp,
                                         blue + (1 - blue) * (1 - red) * ramp};
    const Material m = inside(root, x);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(m.value[c], expected[c], 4e-3) << x.transpose(); // one 8-bit step
    EXPECT_NEAR(m.coverage, 1, 2e-3);
  }
}

TEST(FiveMethods, TheOrderOfPastesMatters) {
  for (int top : {0, 1}) {
    Model model = cube_model(1, size);
    Layer layer = solid_layer(model, size, 2);
    layer.exemplar = {constant("red", 3, {255, 0, 0}), constant("blue", 3, {0, 0, 255})};
    layer.mask = {full_mask(3, 255)};
    layer.patch[0] = {static_cast<std::uint32_t>(1 - top), 0, {}, 0};
    layer.patch[1] = {static_cast<std::uint32_t>(top), 0, {}, 0};
    model.layer.push_back(layer);
    const Root root(std::move(model));
    const Material m = inside(root, {0.3, 0.4, 0.5});
    EXPECT_EQ(m.value[0], top == 0 ? 1 : 0);
    EXPECT_EQ(m.value[2], top == 1 ? 1 : 0);
    EXPECT_EQ(m.lookups_read, 1); // nothing below an opaque one is read
  }
}

TEST(FiveMethods, CornerWeightsFadeAMaskAndCoverageSaysSo) {
  Model model = cube_model(1, size);
  Layer layer;
  layer.patch = {{0, 0, {}, 0}};
  layer.exemplar = {constant("green", 3, {0, 255, 0})};
  layer.mask = {full_mask(3, 204)};
  LayerWriter writer(layer);
  for (TetId t : all_ids<TetId>(model.mesh.tet_count())) {
    std::vector<std::vector<float>> rows;
    for (VertexId v : model.mesh.corner[t])
      rows.push_back({0.5f, 0.5f, 0.5f, float(model.mesh.position[v].z() / size)});
    writer.add(0, rows);
    writer.end_simplex();
  }
  model.layer.push_back(layer);
  const Root root(std::move(model));
  for (const Vec3d& x : random_points(size, 500, 2)) {
    const Material m = inside(root, x);
    EXPECT_NEAR(m.coverage, 0.8 * x.z() / size, 1e-5);
    EXPECT_NEAR(m.value[1], 1, 1e-5); // what there is, is green: never darkened by what is missing
  }
}

// Praun 2000: masked images on the boundary, over a solid.
TEST(FiveMethods, MaskedImagesOnTheSkin) {
  const Root root(masked_images());
  Random random(3);
  for (FacetId f : all_ids<FacetId>(root.model().boundary.facet_count()))
    for (int k = 0; k < 20; ++k) {
      const Vec3d x = facet_point(root.model(), f, random).first;
      const double blue = std::clamp((6 * x.x() / size - 0.5) / 5, 0.0, 1.0), red = 0.4;
      const Material on = material_at(root, {x, -1, f, {}});
      EXPECT_NEAR(on.value[0], (1 - blue) * (red + 0.6), 4e-3);
      EXPECT_NEAR(on.value[1], (1 - blue) * 0.6, 4e-3);
      EXPECT_NEAR(on.value[2], blue + (1 - blue) * 0.6, 4e-3);
      const Material below = material_at(root, {x, -1, {}, {}}); // the same place seen from inside
      EXPECT_FLOAT_EQ(below.value[1], 1);
    }
}

// Ray 2009: one look-up into a periodic (s, t, m) tile; three on triangles around a singular vertex; m is animated.
TEST(FiveMethods, PeriodicTileWithThreeLookUpsAndAnimatedM) {
  const auto wave = [](double s) { // linear interpolation of 0, 60, 120, 180 with period 1
    const double at = 4 * s - 0.5, low = std::floor(at), fraction = at - low;
    const auto value = [](double i) { return 60 * (i - 4 * std::floor(i / 4)); };
    return ((1 - fraction) * value(low) + fraction * value(low + 1)) / 255;
  };
  for (double shift_m : {0.0, 0.2, -0.1}) {
    const Root root(periodic_tile(static_cast<float>(shift_m)));
    Random random(4);
    for (FacetId f : all_ids<FacetId>(root.model().boundary.facet_count()))
      for (int k = 0; k < 10; ++k) {
        const Vec3d x = facet_point(root.model(), f, random).first;
        const Material m = material_at(root, {x, -1, f, {}});
        const double expected_m = 0.25 + 0.5 * x.z() / size + shift_m;
        EXPECT_NEAR(m.value[0], std::clamp(15 * (18 * expected_m - 0.5), 0.0, 255.0) / 255, 1e-3);
        EXPECT_NEAR(m.value[1], wave(x.x() / size), 1e-3);
        EXPECT_NEAR(m.value[2], wave(x.y() / size), 1e-3);
        EXPECT_NEAR(m.coverage, 1, 1e-5);
        EXPECT_EQ(m.lookups_read, f % 2 == 0 ? 1 : 3);
      }
  }
}

// Ying 2001: texture maps with gutters. Two charts of one atlas; a facet's border texels are repeated in the gutter,
// so both sides of a chart border show the same colour.
TEST(FiveMethods, TextureMapsWithGuttersMeetWithoutASeam) {
  const Root root(gutter_atlas());
  Random random(5);
  for (FacetId f : all_ids<FacetId>(root.model().boundary.facet_count())) {
    const auto& c = root.model().boundary.corner[f];
    for (int k = 0; k < 10; ++k) { // points on edges belong to two facets, here mostly of different cells
      const double t = random.uniform();
      const Vec3d x = (1 - t) * root.model().mesh.position[c[k % 3]] + t * root.model().mesh.position[c[(k + 1) % 3]];
      EXPECT_NEAR(material_at(root, {x, -1, f, {}}).value[0], pattern(x.x() / size, x.y() / size) / 255, 1e-4);
    }
  }
}

TEST(FiveMethods, PatchesSelectByHeightWithGrace) {
  const auto flat = [](const char* name, int red, int height, int roughness) {
    return exemplar_of(name, 2, {1, 1, 1}, Wrap::repeat, pbr(), [=](int, int, int) {
      return std::vector<int>{red, 0, 255 - red, height, roughness};
    });
  };
  for (auto select : {Blend::Select::max, Blend::Select::min}) {
    Exemplar a = flat("a", 255, 204, 255), b = flat("b", 0, 102, 0);
    const Root root(two_patches({select, 0.2f, Blend::Mix::linear}, a, b));
    Random random(6);
    for (FacetId f : all_ids<FacetId>(root.model().boundary.facet_count()))
      for (int k = 0; k < 10; ++k) {
        const Vec3d x = facet_point(root.model(), f, random).first;
        const double w = x.x() / size;
        const double first = (1 - w) * (select == Blend::Select::max ? 0.8 : 0.2);
        const double second = w * (select == Blend::Select::max ? 0.4 : 0.6);
        const double floor = std::max(0.0, std::max(first, second) - 0.2);
        const double wa = std::max(0.0, first - floor), wb = std::max(0.0, second - floor);
        const Material m = material_at(root, {x, -1, f, {}});
        EXPECT_NEAR(m.value[0], wa / (wa + wb), 2e-5);
        EXPECT_NEAR(m.value[root.component_of("roughness")], wa / (wa + wb), 2e-5);
        EXPECT_FLOAT_EQ(m.coverage, 1);
      }
  }
}

/// On a facet whose corners show (0, 0), (2, 0) and (0, 2): the centre of a texel of 64².
SimplexPoint texel_center(int i, int j) {
  SimplexPoint point;
  point.barycentric[1] = (i + 0.5f) / 128;
  point.barycentric[2] = (j + 0.5f) / 128;
  point.barycentric[0] = 1 - point.barycentric[1] - point.barycentric[2];
  return point;
}

TEST(FiveMethods, HistogramMixingKeepsMeanAndVariance) {
  // One triangle over the whole texture, two patches of independent noise at equal weights, read at texel centres.
  Layer layer;
  layer.domain = Domain::skin;
  layer.width = 2;
  layer.exemplar = {skewed_noise(1), skewed_noise(2)};
  layer.exemplar[1].inverse = layer.exemplar[0].inverse;
  layer.patch = {{0, Patch::no_mask, {}, 0}, {1, Patch::no_mask, {}, 0}};
  LayerWriter writer(layer);
  for (std::uint32_t p : {0u, 1u}) writer.add(p, {{0, 0, 0.5f}, {2, 0, 0.5f}, {0, 2, 0.5f}});
  writer.end_simplex();
  double mean[3] = {}, variance[3] = {};
  for (auto mix : {Blend::Mix::over, Blend::Mix::linear, Blend::Mix::histogram}) {
    layer.blend.mix = mix;
    const LayerReader reader(layer, false);
    const int row = mix == Blend::Mix::over ? 0 : mix == Blend::Mix::linear ? 1 : 2;
    const std::span<const Lookup> both(layer.lookup), first = both.first(1); // `over` reads one noise alone
    for (int j = 0; j < 64; ++j)
      for (int i = 0; i < 64; ++i) {
        const SimplexPoint point = texel_center(i, j);
        const LayerValue at = composite(reader, row == 0 ? first : both, point);
        const double value = at.value[0] / at.coverage;
        mean[row] += value / 4096;
        variance[row] += value * value / 4096;
      }
    variance[row] -= mean[row] * mean[row];
  }
  EXPECT_NEAR(variance[1] / variance[0], 0.5, 0.05); // a plain mean loses half the contrast
  EXPECT_NEAR(variance[2] / variance[0], 1.0, 0.1);
  EXPECT_NEAR(mean[1], mean[0], 0.01);
  EXPECT_NEAR(mean[2], mean[0], 0.02);
}

TEST(FiveMethods, MixingAboutAMeanThatVariesKeepsMeanAndVariance) {
  // Noise about a mean that rises along y, which both look-ups share; they meet at shares w and 1 − w.
  Exemplar graded = exemplar_of("graded", 2, {64, 64, 1}, Wrap::repeat, linear_color(),
                                [random = Random(7)](int, int y, int) mutable {
                                  const int v = 60 + 2 * y + static_cast<int>(50 * (random.uniform() - 0.5));
                                  return std::vector<int>{v, v, v};
                                });
  graded.wrap[1] = Wrap::clamp;
  Layer layer;
  layer.domain = Domain::skin;
  layer.width = 2;
  layer.exemplar = {graded};
  layer.patch = {{0, Patch::no_mask, {}, 0}, {0, Patch::no_mask, {}, 0}};
  layer.patch[1].frame.offset[0] = 20.5f / 64; // other texels, and between them: a variance of its own
  struct Row {
    double offset = 0, squares = 0;
    void add(double value, int y) {
      const double away = value - (60 + 2 * y) / 255.0;
      offset += away / 4096;
      squares += away * away / 4096;
    }
  };
  const auto measured = [&](Blend blend, float first, float second) {
    layer.blend = blend;
    layer.lookup.clear();
    layer.corner.clear();
    layer.begin.clear();
    LayerWriter writer(layer);
    writer.add(0, {{0, 0, first}, {2, 0, first}, {0, 2, first}});
    writer.add(1, {{0, 0, second}, {2, 0, second}, {0, 2, second}});
    writer.end_simplex();
    const LayerReader reader(layer, false);
    Row row;
    for (int j = 0; j < 64; ++j)
      for (int i = 0; i < 64; ++i) {
        const SimplexPoint point = texel_center(i, j);
        const LayerValue at = composite(reader, layer.lookup, point);
        EXPECT_FLOAT_EQ(at.coverage, 1);
        row.add(at.value[0], j);
      }
    return row;
  };
  const Blend plain, preserving{.mean_over = {true, false}};
  const Row below = measured(plain, 1, 0), above = measured(plain, 1, 1);
  for (const float share : {0.2f, 0.5f, 0.7f}) {
    const double w = share, expected = (w * w * above.squares + (1 - w) * (1 - w) * below.squares);
    const Row mixed = measured(plain, 1, share), kept = measured(preserving, 1, share);
    EXPECT_NEAR(mixed.squares / expected, 1, 0.1) << "independent";
    EXPECT_NEAR(kept.squares / (expected / (w * w + (1 - w) * (1 - w))), 1, 0.1);
    EXPECT_NEAR(kept.offset, 0, 0.01);
    Blend linear = preserving;
    linear.mix = Blend::Mix::linear;
    const Row weighted = measured(linear, 1 - share, share);
    EXPECT_NEAR(weighted.squares, kept.squares, 1e-6);
  }
  Blend alike = preserving;
  alike.correlation = 1; // then nothing is lost, and nothing to be made good
  EXPECT_NEAR(measured(alike, 1, 0.4f).squares, measured(plain, 1, 0.4f).squares, 1e-6);
  const Row alone = measured(preserving, 1, 0);
  EXPECT_EQ(alone.squares, below.squares) << "nothing is mixed";
}

TEST(FiveMethods, MoreWeightedLookUpsThanTheLimitDropTheSmallest) {
  Model model = cube_model(1, size);
  Layer layer;
  layer.blend.mix = Blend::Mix::linear;
  layer.exemplar = {constant("white", 3, {255, 255, 255}), constant("black", 3, {0, 0, 0})};
  layer.patch = {{0, Patch::no_mask, {}, 0}, {1, Patch::no_mask, {}, 0}};
  LayerWriter writer(layer);
  for (TetId t : all_ids<TetId>(model.mesh.tet_count())) {
    (void)t;
    for (int i = 0; i < max_weighted_lookups + 8; ++i) {
      const bool small = i % 3 == 0; // exactly a third are small and black: they are the ones to go
      const std::vector<float> row{0.5f, 0.5f, 0.5f, small ? 0.01f : 1.0f};
      writer.add(small ? 1 : 0, {row, row, row, row});
    }
    writer.end_simplex();
  }
  model.layer.push_back(layer);
  const Root root(std::move(model));
  const Material m = inside(root, {0.5, 0.6, 0.7});
  EXPECT_FLOAT_EQ(m.value[0], 1);
  EXPECT_EQ(m.lookups_read, max_weighted_lookups);
}

TEST(Directions, AreCarriedToRestSpaceThroughTheLookUp) {
  // Texture coordinates are turned by 90° about z and stretched: the fibre (texture x) must run along rest y.
  Model model = cube_model(2, size);
  Layer layer;
  layer.exemplar = {
      exemplar_of("fibre", 3, {1, 1, 1}, Wrap::clamp,
                  {{"color", Semantic::color, 3, false, 0, 1}, {"fibre", Semantic::direction, 3, false, -1, 1}},
                  [](int, int, int) { return std::vector<int>{255, 255, 255, 255, 128, 128}; })};
  layer.patch = {{}};
  LayerWriter writer(layer);
  for (TetId t : all_ids<TetId>(model.mesh.tet_count())) {
    std::vector<std::vector<float>> rows;
    for (VertexId v : model.mesh.corner[t]) {
      const Vec3d x = model.mesh.position[v];
      rows.push_back({float(0.3 * x.y()), float(-0.1 * x.x()), float(0.2 * x.z()), 1.0f});
    }
    writer.add(0, rows);
    writer.end_simplex();
  }
  model.layer.push_back(layer);
  const Root root(std::move(model));
  const int fibre = root.component_of("fibre");
  ASSERT_EQ(fibre, 3);
  const Material m = inside(root, {0.4, 0.5, 0.6});
  EXPECT_NEAR(m.value[fibre + 1], 1, 0.05);
  EXPECT_NEAR(m.value[fibre], 0, 0.05);
  EXPECT_NEAR(m.value[fibre + 2], 0, 0.05);
}

TEST(Footprint, FiltersTowardsTheMeanAndZeroIsThePointItself) {
  Model model = cube_model(1, size);
  Layer layer = solid_layer(model, size, 1);
  layer.exemplar = {exemplar_of("checker", 3, {32, 32, 32}, Wrap::repeat, linear_color(),
                                [](int x, int y, int z) { return std::vector<int>(3, (x + y + z) % 2 ? 255 : 0); })};
  layer.patch[0] = {0, Patch::no_mask, {}, 0};
  model.layer.push_back(layer);
  const Root root(std::move(model));
  const Vec3d x = Vec3d(3.5, 4.5, 7.5) / 32 * size; // a texel's centre
  EXPECT_FLOAT_EQ(inside(root, x).value[0], material_at(root, {x, -1, {}, {}}, 0).value[0]);
  EXPECT_NEAR(inside(root, x).value[0], 0, 1e-4);
  EXPECT_NEAR(material_at(root, {x, -1, {}, {}}, 0.2).value[0], 0.5, 0.02);
}

} // namespace
} // namespace pith
