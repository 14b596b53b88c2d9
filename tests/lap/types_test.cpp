// Every type of solid texture on a bent bar: no holes, axes along the field, what the type leaves free left to
// chance, the same bytes at any number of threads; and refusals.
#include "tests/lap/types_fixture.h"

#include "volume/base/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>

namespace pith {
namespace {

using testing::BentBar;
using testing::pasted_axes;
using testing::TypeCase;

constexpr double degree = std::numbers::pi / 180;

double quantile(std::vector<double> values, double q) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

class Types : public ::testing::TestWithParam<TextureType> {
protected:
  static void SetUpTestSuite() { bar = new BentBar; }
  static void TearDownTestSuite() { delete bar; }
  static inline BentBar* bar = nullptr;
};

std::string name_of(const ::testing::TestParamInfo<TextureType>& info) {
  std::string name = traits_of(info.param).name;
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Lap, Types,
                         ::testing::Values(TextureType::isotropic_0, TextureType::axis_1a, TextureType::axis_1b,
                                           TextureType::tensor_2a, TextureType::tensor_2b, TextureType::tensor_2c,
                                           TextureType::tensor_2d),
                         name_of);

/// Those of which a part of the frame is free.
class FreeTypes : public Types {};
INSTANTIATE_TEST_SUITE_P(Lap, FreeTypes,
                         ::testing::Values(TextureType::isotropic_0, TextureType::axis_1a, TextureType::axis_1b),
                         name_of);

TEST_P(Types, CoverEveryPoint) {
  const TypeCase one(*bar, GetParam());
  LapResult result = one.filled();
  ASSERT_NO_THROW(validate(result.layer, bar->mesh.tet_count()));
  const LayerReader reader(result.layer, false);
  Random random(1);
  int holes = 0, thin = 0;
  for (const TetId t : all_ids<TetId>(bar->mesh.tet_count()))
    for (int k = 0; k < 10; ++k) {
      SimplexPoint point;
      float sum = 0;
      for (float& b : point.barycentric) sum += b = static_cast<float>(-std::log(1 - random.uniform()));
      for (float& b : point.barycentric) b /= sum;
      const std::span<const Lookup> row(result.layer.lookup.data() + result.layer.begin[t],
                                        result.layer.lookup.data() + result.layer.begin[t + 1]);
      const float coverage = coverage_of(reader, row, point).coverage;
      holes += coverage < 0.95f;
      thin += coverage < 0.99f;
    }
  EXPECT_EQ(holes, 0);
  EXPECT_LT(thin, bar->mesh.tet_count() / 100); // 0.1 % of the points
}

/// Angles between the exemplar's axes, where they were pasted, and the field's.
TEST_P(Types, FollowTheirFields) {
  const TypeCase one(*bar, GetParam());
  const TextureTraits& traits = traits_of(one.type);
  const LapResult result = one.filled();
  std::vector<double> angle, stretch;
  for (const TetId t : all_ids<TetId>(bar->mesh.tet_count())) {
    if (one.frames.singular[t]) continue;
    for (std::uint32_t i = result.layer.begin[t]; i < result.layer.begin[t + 1]; ++i) {
      const Mat3d axes = pasted_axes(bar->mesh, t, result.layer, result.layer.lookup[i]);
      EXPECT_GT(axes.determinant(), 0) << "a look-up is turned inside out";
      for (int a = 0; a < 3; ++a) {
        const bool fixed = traits.fixed_axes == 3 || (traits.fixed_axes == 1 && a == traits.fixed_axis);
        if (fixed)
          angle.push_back(std::acos(std::clamp(axes.col(a).normalized().dot(one.frames.axes[t].col(a)), -1.0, 1.0)) /
                          degree);
        if (!traits.imposed[a]) stretch.push_back(axes.col(a).norm() / one.frames.scale[t]);
      }
    }
  }
  if (traits.fixed_axes > 0) {
    EXPECT_LE(quantile(angle, 0.5), 3);
    EXPECT_LE(quantile(angle, 0.95), 15);
  }
  if (!stretch.empty()) {
    EXPECT_NEAR(quantile(stretch, 0.5), 1, 0.05);
    EXPECT_GT(quantile(stretch, 0.05), 0.7);
    EXPECT_LT(quantile(stretch, 0.95), 1.4);
  }
}

TEST_P(Types, AreTheSameAtOneAndTwoThreads) {
  const TypeCase one(*bar, GetParam());
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return one.filled().layer;
  };
  const Layer a = run(1), b = run(2);
  EXPECT_EQ(a.begin, b.begin);
  EXPECT_EQ(a.corner, b.corner);
  ASSERT_EQ(a.lookup.size(), b.lookup.size());
  EXPECT_EQ(std::memcmp(a.lookup.data(), b.lookup.data(), a.lookup.size() * sizeof(Lookup)), 0);
  ASSERT_EQ(a.patch.size(), b.patch.size());
  for (std::size_t i = 0; i < a.patch.size(); ++i) EXPECT_EQ(a.patch[i].frame.offset, b.patch[i].frame.offset);
}

/// What the type leaves free differs from paste to paste, and is everywhere alike often.
TEST_P(FreeTypes, TurnPastesAtRandomAboutWhatIsFree) {
  const TypeCase one(*bar, GetParam());
  const TextureTraits& traits = traits_of(one.type);
  const LapResult result = one.filled();
  std::map<std::uint32_t, Mat3d> turn; // of each patch against the bar's own frame, on the first tet that shows it
  for (const TetId t : all_ids<TetId>(bar->mesh.tet_count()))
    for (std::uint32_t i = result.layer.begin[t]; i < result.layer.begin[t + 1]; ++i) {
      const Lookup& lookup = result.layer.lookup[i];
      if (turn.count(lookup.patch)) continue;
      const Vec3d x = barycenter(bar->mesh, t);
      Mat3d own;
      own << Vec3d::UnitY(), BentBar::outwards(x), BentBar::tangent(x);
      Mat3d axes = pasted_axes(bar->mesh, t, result.layer, lookup);
      axes.colwise().normalize();
      turn[lookup.patch] = own.transpose() * axes;
    }
  ASSERT_GT(turn.size(), 40u);
  for (int a = 0; a < 3; ++a) {
    Vec3d mean = Vec3d::Zero();
    Mat3d spread = Mat3d::Zero();
    for (const auto& [patch, r] : turn) {
      mean += r.col(a) / double(turn.size());
      spread += r.col(a) * r.col(a).transpose() / double(turn.size());
    }
    if (traits.fixed_axes == 1 && a == traits.fixed_axis) {
      EXPECT_GT(mean.norm(), 0.97);
      continue;
    }
    const double chance = 4 / std::sqrt(double(turn.size())); // four standard deviations
    EXPECT_LT(mean.norm(), chance);
    for (int k = 0; k < 3; ++k) {
      const double expected = traits.fixed_axes == 0 ? 1.0 / 3 : k == traits.fixed_axis ? 0 : 0.5;
      EXPECT_NEAR(spread(k, k), expected, 0.5 * chance);
    }
  }
}

TEST(TextureTypes, OfThreeFieldsShowThemInClosedForm) {
  const BentBar bar(4);
  TypeCase one(bar, TextureType::tensor_2d);
  // Red, green, blue rise with R, S, T: texel i of 32 holds 8 i.
  one.exemplar.channel[0].srgb = false;
  for (int z = 0; z < 32; ++z)
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        std::uint8_t* texel = one.exemplar.at(x, y, z);
        texel[0] = static_cast<std::uint8_t>(8 * x), texel[1] = static_cast<std::uint8_t>(8 * y),
        texel[2] = static_cast<std::uint8_t>(8 * z);
      }
  Model model;
  model.mesh = bar.mesh;
  model.boundary = bar.boundary;
  LapResult result = one.filled();
  EXPECT_EQ(result.layer.patch.size(), 1u);
  EXPECT_EQ(result.layer.lookup.size(), bar.mesh.tet_count());
  model.layer.push_back(std::move(result.layer));
  const Root root(std::move(model), {.mips = false});
  Random random(2);
  for (int k = 0; k < 2000; ++k) {
    const TetId t(random.below(static_cast<std::uint32_t>(bar.mesh.tet_count())));
    std::array<double, 4> b;
    double sum = 0;
    for (double& one_of : b) sum += one_of = -std::log(1 - random.uniform());
    Vec3d x = Vec3d::Zero();
    std::array<double, 3> u{};
    for (int i = 0; i < 4; ++i) {
      const VertexId v = bar.mesh.corner[t][i];
      x += b[i] / sum * bar.mesh.position[v];
      u[0] += b[i] / sum * one.around.value[v];
      u[1] += b[i] / sum * one.depth.value[v];
      u[2] += b[i] / sum * one.along.value[v];
    }
    const Material m = material_at(root, {.position = x, .region = -1, .facet = {}, .hint = {}});
    EXPECT_EQ(m.coverage, 1);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(m.value[c], std::clamp(32 * u[c] - 0.5, 0.0, 31.0) * 8 / 255, 1e-4);
  }
}

TEST(TextureTypes, OfTwoFieldsAreSheetsWithoutEndsAlongT) {
  // One paste reaches from one end of the bar to the other.
  const BentBar bar;
  const TypeCase one(bar, TextureType::tensor_2c);
  const LapResult result = one.filled();
  std::vector<std::pair<float, float>> reach(result.layer.patch.size(), {1, 0});
  for (const Lookup& lookup : result.layer.lookup)
    for (const std::uint32_t corner : lookup.corner) {
      auto& [low, high] = reach[lookup.patch];
      low = std::min(low, result.layer.corner[4 * std::size_t(corner) + 2]);
      high = std::max(high, result.layer.corner[4 * std::size_t(corner) + 2]);
    }
  float longest = 0;
  for (const auto& [low, high] : reach) longest = std::max(longest, high - low);
  EXPECT_GT(longest, 0.6f); // the tolerance of 0.8 radians of a quarter circle, to both sides
}

TEST(TextureTypes, LocalScaleMakesTheTextureLarger) {
  const BentBar bar;
  const std::vector<ScaleConstraint> local{{.stroke = {BentBar::place(0.5, 0.5, 0)}, .factor = 0.7},
                                           {.stroke = {BentBar::place(0.5, 0.5, 1)}, .factor = 1.6}};
  TypeCase one(bar, TextureType::isotropic_0);
  one.frames = frames_of({.mesh = bar.mesh, .locator = bar.locator, .scale = 8, .local_scale = local});
  const LapResult result = one.filled();
  std::vector<double> near, far;
  for (const TetId t : all_ids<TetId>(bar.mesh.tet_count())) {
    const Vec3d x = barycenter(bar.mesh, t);
    const double along = std::atan2(x.z(), x.x()) / (std::numbers::pi / 2);
    for (std::uint32_t i = result.layer.begin[t]; i < result.layer.begin[t + 1]; ++i) {
      const double width = std::cbrt(pasted_axes(bar.mesh, t, result.layer, result.layer.lookup[i]).determinant());
      if (along < 0.1) near.push_back(width);
      if (along > 0.9) far.push_back(width);
    }
  }
  EXPECT_NEAR(quantile(near, 0.5), 8 * 0.7, 0.8);
  EXPECT_NEAR(quantile(far, 0.5), 8 * 1.6, 1.6);
}

TEST(TextureTypes, AnAxisWithoutSignIsFollowedWhicheverWayItsTetsHaveIt) {
  const BentBar bar;
  TypeCase one(bar, TextureType::axis_1a);
  Random random(8);
  for (Mat3d& axes : one.frames.axes)
    if (random.uniform() < 0.5) axes.col(0) *= -1, axes.col(2) *= -1; // turned over at random
  LapInput input = one.input();
  input.unsigned_axis = true;
  const LapResult result = lap(input, one.exemplar, one.options);
  std::vector<double> angle;
  for (const TetId t : all_ids<TetId>(bar.mesh.tet_count()))
    for (std::uint32_t i = result.layer.begin[t]; i < result.layer.begin[t + 1]; ++i) {
      const Vec3d along = pasted_axes(bar.mesh, t, result.layer, result.layer.lookup[i]).col(2).normalized();
      angle.push_back(std::acos(std::min(1.0, std::abs(along.dot(one.frames.axes[t].col(2))))) / degree);
    }
  EXPECT_LE(quantile(angle, 0.5), 3);
  EXPECT_LE(quantile(angle, 0.95), 15);
}

TEST(TextureTypes, HaveNamesAndBack) {
  for (int k = 0; k < texture_type_count; ++k) {
    const TextureType type = static_cast<TextureType>(k);
    EXPECT_EQ(texture_type_of(traits_of(type).name), type);
  }
  EXPECT_EQ(texture_type_of("3-a"), std::nullopt);
}

TEST(TextureTypes, RefuseWhatDoesNotFitByKey) {
  const BentBar bar(2);
  const auto message = [&](const LapInput& input, const Exemplar& exemplar, TextureType type) -> std::string {
    LapOptions options;
    options.type = type;
    try {
      lap(input, exemplar, options);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "accepted";
  };
  const auto expect_begin = [](const std::string& text, const std::string& begin) {
    EXPECT_EQ(text.substr(0, begin.size()), begin);
  };
  TypeCase one(bar, TextureType::axis_1a, 20);
  LapInput input = one.input();
  input.where = "x.json: /solids/0";
  Exemplar clamped = one.exemplar;
  clamped.wrap[2] = Wrap::clamp;
  expect_begin(message(input, clamped, TextureType::axis_1a),
               "x.json: /solids/0/exemplar: 'noise' does not repeat along axis 2 (T), along which type 1-a tiles; ");
  expect_begin(message(input, one.exemplar, TextureType::axis_1b), "x.json: /solids/0/depth: is missing: type 1-b");
  expect_begin(message(input, one.exemplar, TextureType::tensor_2c), "x.json: /solids/0/depth: is missing: type 2-c");
  expect_begin(message(input, one.exemplar, TextureType::tensor_2d),
               "x.json: /solids/0/around: is missing: type 2-d");
  const std::vector<float> none(bar.mesh.tet_count(), 0.0f);
  input.scale = none;
  expect_begin(message(input, one.exemplar, TextureType::axis_1a), "x.json: /solids/0/scale: is 0");
  LapInput frameless = one.input();
  frameless.axes = {};
  expect_begin(message(frameless, one.exemplar, TextureType::axis_1a), "fill: was given frames for 0 of");
  EXPECT_EQ(message(frameless, one.exemplar, TextureType::isotropic_0), "accepted"); // needs none
}

} // namespace
} // namespace pith
