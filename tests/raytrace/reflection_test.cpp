#include "raytrace/reflection.h"

#include <gtest/gtest.h>

namespace pith {
namespace {

constexpr double pi = std::numbers::pi;

Vec3d direction(double cosine, double angle) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(angle), sine * std::sin(angle), cosine};
}

/// ∫ f over the upper hemisphere by the midpoint rule, finer towards the horizon and around the mirror direction's
/// ring.
template <class Function>
double integral(const Function& f, int rows = 900, int columns = 900) {
  double sum = 0;
  for (int i = 0; i < rows; ++i) {
    const double cosine = (i + 0.5) / rows;
    for (int j = 0; j < columns; ++j) sum += f(direction(cosine, 2 * pi * (j + 0.5) / columns));
  }
  return sum * 2 * pi / (double(rows) * columns);
}

struct Case {
  double roughness, cosine;
};
class Coat : public ::testing::TestWithParam<Case> {};

const CoatTable& table() {
  static const CoatTable made;
  return made;
}

TEST_P(Coat, WhiteBodyUnderAnyCoatReflectsAllLight) {
  const Vec3d out = direction(GetParam().cosine, 0.3);
  const Reflection reflection(Vec3d::Ones(), GetParam().roughness, 1.4, table(), out.z());
  EXPECT_NEAR(integral([&](const Vec3d& in) { return reflection.value(out, in).x(); }), 1, 4e-3);
}

TEST_P(Coat, ReflectsNoMoreThanItGets) {
  const Vec3d out = direction(GetParam().cosine, 0.3);
  for (const double index : {1.2, 1.4, 2.0}) {
    const Reflection black(Vec3d::Zero(), GetParam().roughness, index, table(), out.z());
    const double reflected = integral([&](const Vec3d& in) { return black.value(out, in).x(); });
    EXPECT_LT(reflected, 1.0);
    EXPECT_NEAR(reflected, table().directional(out.z(), GetParam().roughness, std::pow((index - 1) / (index + 1), 2)),
                4e-3);
  }
}

TEST_P(Coat, DensityIntegratesToTheShareOfSamplesAboveTheSurface) {
  const Vec3d out = direction(GetParam().cosine, 0.3);
  const Reflection reflection({0.4, 0.5, 0.2}, GetParam().roughness, 1.4, table(), out.z());
  int above = 0;
  constexpr int count = 100000;
  for (int i = 0; i < count; ++i) {
    PixelSampler sampler(7, 1, i);
    const auto u = sampler.next(), choice = sampler.next();
    above += reflection.sample(out, u, choice[0]).density > 0;
  }
  EXPECT_NEAR(integral([&](const Vec3d& in) { return reflection.density(out, in); }), double(above) / count, 6e-3);
}

/// Pearson's test of where samples fall against the integral of the density over each cell.
TEST_P(Coat, SamplesFollowTheirDensity) {
  const Vec3d out = direction(GetParam().cosine, 0.3);
  const Reflection reflection({0.4, 0.5, 0.2}, GetParam().roughness, 1.4, table(), out.z());
  constexpr int rows = 8, columns = 16, fine = 60, count = 200000;
  std::array<double, rows * columns> expected{}, seen{};
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      for (int i = 0; i < fine; ++i)
        for (int j = 0; j < fine; ++j)
          expected[r * columns + c] += reflection.density(out, direction((r + (i + 0.5) / fine) / rows,
                                                                         2 * pi * (c + (j + 0.5) / fine) / columns)) *
                                       count * 2 * pi / (rows * columns * fine * fine);
  Random random(11, std::uint64_t(1e6 * GetParam().roughness), std::uint64_t(1e6 * GetParam().cosine));
  for (int i = 0; i < count; ++i) {
    const double a = random.uniform(), b = random.uniform();
    const auto sample = reflection.sample(out, {a, b}, random.uniform());
    if (!(sample.density > 0)) continue;
    double angle = std::atan2(sample.direction.y(), sample.direction.x()) / (2 * pi);
    if (angle < 0) angle += 1;
    const int r = std::min(rows - 1, int(sample.direction.z() * rows)),
              c = std::min(columns - 1, int(angle * columns));
    seen[r * columns + c] += 1;
  }
  double statistic = 0;
  int cells = 0;
  for (int i = 0; i < rows * columns; ++i) {
    if (expected[i] < 20) continue;
    statistic += (seen[i] - expected[i]) * (seen[i] - expected[i]) / expected[i];
    ++cells;
  }
  ASSERT_GT(cells, 20);
  EXPECT_LT(statistic, cells + 5 * std::sqrt(2.0 * cells)); // five standard deviations
}

TEST_P(Coat, IsReciprocal) {
  for (int i = 0; i < 200; ++i) {
    Random random(3, i);
    const Vec3d a = direction(0.02 + 0.97 * random.uniform(), 6 * random.uniform());
    const Vec3d b = direction(0.02 + 0.97 * random.uniform(), 6 * random.uniform());
    const Vec3d albedo(0.3, 0.6, 0.9);
    const Vec3d ab = Reflection(albedo, GetParam().roughness, 1.4, table(), a.z()).value(a, b) / b.z();
    const Vec3d ba = Reflection(albedo, GetParam().roughness, 1.4, table(), b.z()).value(b, a) / a.z();
    EXPECT_LT((ab - ba).norm(), 1e-9 * (1 + ab.norm()));
  }
}

INSTANTIATE_TEST_SUITE_P(Table, Coat,
                         ::testing::Values(Case{0.28, 0.95}, Case{0.28, 0.5}, Case{0.28, 0.15}, Case{0.7, 0.9},
                                           Case{0.7, 0.3}, Case{1, 0.6}, Case{0.5, 0.05}));

TEST(PixelSampler, IsUniformAndStratified) {
  // 256 samples of one pixel put exactly one into each of 256 strips, along either axis, and one into each of 16 × 16
  // boxes, for every pair of dimensions (a (0, 8, 2)-net).
  for (const std::uint64_t pixel : {0ull, 1ull, 12345ull}) {
    std::array<std::array<int, 256>, 6> x{}, y{}, box{};
    for (std::uint32_t s = 0; s < 256; ++s) {
      PixelSampler sampler(5, pixel, s);
      for (int pair = 0; pair < 6; ++pair) {
        const auto [a, b] = sampler.next();
        ASSERT_TRUE(a >= 0 && a < 1 && b >= 0 && b < 1);
        ++x[pair][int(a * 256)];
        ++y[pair][int(b * 256)];
        ++box[pair][int(a * 16) * 16 + int(b * 16)];
      }
    }
    for (int pair = 0; pair < 6; ++pair)
      for (int i = 0; i < 256; ++i) {
        EXPECT_EQ(x[pair][i], 1);
        EXPECT_EQ(y[pair][i], 1);
        EXPECT_EQ(box[pair][i], 1);
      }
  }
}

TEST(PixelSampler, PairsDoNotRepeatOneAnother) {
  double correlation = 0;
  constexpr int count = 1024;
  for (std::uint32_t s = 0; s < count; ++s) {
    PixelSampler sampler(5, 9, s);
    const auto a = sampler.next(), b = sampler.next();
    correlation += 12 * (a[0] - 0.5) * (b[0] - 0.5) / count;
  }
  EXPECT_LT(std::abs(correlation), 0.1);
}

TEST(PixelFilter, IsCentredAndNarrow) {
  const PixelFilter filter;
  double mean = 0, square = 0, last = -2;
  constexpr int count = 10000;
  for (int i = 0; i < count; ++i) {
    const double x = filter.offset((i + 0.5) / count);
    EXPECT_GE(x, last);
    last = x;
    mean += x / count;
    square += x * x / count;
  }
  EXPECT_NEAR(mean, 0, 1e-9);
  EXPECT_NEAR(std::sqrt(square), 0.39, 0.04);
}

} // namespace
} // namespace pith
