#include "volume/field/radial_basis.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"

#include <gtest/gtest.h>

#include <cstring>

using namespace pith;

namespace {

constexpr Kernel all_kernels[] = {Kernel::biharmonic, Kernel::triharmonic, Kernel::thin_plate};

std::vector<Vec3d> random_points(int count, std::uint64_t seed, const Vec3d& low, const Vec3d& high) {
  std::vector<Vec3d> points;
  for (int i = 0; i < count; ++i) {
    Random random(seed, i);
    const double x = random.uniform(low.x(), high.x()), y = random.uniform(low.y(), high.y()),
                 z = random.uniform(low.z(), high.z());
    points.push_back({x, y, z});
  }
  return points;
}

template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

double wave(const Vec3d& x) { return std::sin(0.07 * x.x()) + 0.02 * x.y() * std::cos(0.05 * x.z()); }

} // namespace

TEST(RadialBasis, ReproducesLinearFunctions) {
  const auto linear = [](const Vec3d& x) { return 3 + 0.25 * x.x() - 2 * x.y() + 0.125 * x.z(); };
  const std::vector<Vec3d> centers = random_points(150, 1, {-20, 10, 100}, {30, 40, 120});
  std::vector<double> values;
  for (const Vec3d& c : centers) values.push_back(linear(c));
  for (const Kernel kernel : all_kernels) {
    const RadialBasis basis = RadialBasis::fit(centers, values, {.kernel = kernel});
    for (const Vec3d& x : random_points(50, 2, {-40, 0, 90}, {50, 50, 130})) {
      EXPECT_NEAR(basis.value(x), linear(x), 1e-8);
      EXPECT_LT((basis.gradient(x) - Vec3d(0.25, -2, 0.125)).norm(), 1e-8);
    }
  }
}

TEST(RadialBasis, InterpolatesScatteredValues) {
  const std::vector<Vec3d> centers = random_points(400, 3, {0, 0, 0}, {50, 60, 70});
  std::vector<double> values;
  for (const Vec3d& c : centers) values.push_back(wave(c));
  for (const Kernel kernel : all_kernels) {
    const RadialBasis basis = RadialBasis::fit(centers, values, {.kernel = kernel});
    EXPECT_EQ(basis.center_count(), 400u);
    for (std::size_t i = 0; i < centers.size(); ++i) EXPECT_NEAR(basis.value(centers[i]), values[i], 1e-9);
  }
}

// r³ is the smoothest interpolant: between the centres it must come near a smooth function.
TEST(RadialBasis, ApproximatesASmoothFunctionBetweenTheCenters) {
  const std::vector<Vec3d> centers = random_points(800, 3, {0, 0, 0}, {50, 60, 70});
  std::vector<double> values;
  for (const Vec3d& c : centers) values.push_back(wave(c));
  const RadialBasis basis = RadialBasis::fit(centers, values);
  for (const Vec3d& x : random_points(100, 4, {5, 5, 5}, {45, 55, 65})) EXPECT_NEAR(basis.value(x), wave(x), 0.02);
}

TEST(RadialBasis, GradientAgreesWithFiniteDifferences) {
  const std::vector<Vec3d> centers = random_points(100, 5, {0, 0, 0}, {50, 60, 70});
  std::vector<double> values;
  for (const Vec3d& c : centers) values.push_back(wave(c));
  for (const Kernel kernel : all_kernels) {
    const RadialBasis basis = RadialBasis::fit(centers, values, {.kernel = kernel});
    for (const Vec3d& x : random_points(40, 6, {0, 0, 0}, {50, 60, 70})) {
      const double step = 1e-4;
      Vec3d difference;
      for (int k = 0; k < 3; ++k)
        difference[k] =
            (basis.value(x + step * Vec3d::Unit(k)) - basis.value(x - step * Vec3d::Unit(k))) / (2 * step);
      EXPECT_LT((basis.gradient(x) - difference).norm(), 2e-6) << x.transpose();
    }
  }
}

TEST(RadialBasis, GradientIsFiniteAtTheCenters) {
  const std::vector<Vec3d> centers = random_points(30, 7, {0, 0, 0}, {1, 1, 1});
  std::vector<double> values;
  for (const Vec3d& c : centers) values.push_back(c.squaredNorm());
  for (const Kernel kernel : all_kernels) {
    const RadialBasis basis = RadialBasis::fit(centers, values, {.kernel = kernel});
    for (const Vec3d& c : centers) EXPECT_TRUE(basis.gradient(c).allFinite());
  }
}

TEST(RadialBasis, TheBatchEqualsTheSingleBitForBitOnAnyNumberOfThreads) {
  const std::vector<Vec3d> centers = random_points(317, 8, {0, 0, 0}, {50, 60, 70}),
                           points = random_points(3001, 9, {0, 0, 0}, {50, 60, 70});
  std::vector<double> values;
  for (const Vec3d& c : centers) values.push_back(wave(c));
  std::vector<std::vector<double>> runs;
  for (const int threads : {1, 2, 0}) {
    const ThreadLimit limit(threads);
    const RadialBasis basis = RadialBasis::fit(centers, values);
    std::vector<double> result(points.size());
    std::vector<Vec3d> gradient(points.size());
    basis.values(points, result);
    basis.gradients(points, gradient);
    for (std::size_t i = 0; i < points.size(); i += 37) {
      ASSERT_TRUE(same_bits(result[i], basis.value(points[i])));
      ASSERT_TRUE(same_bits(gradient[i], basis.gradient(points[i])));
    }
    for (const Vec3d& g : gradient) result.insert(result.end(), g.data(), g.data() + 3);
    runs.push_back(result);
  }
  EXPECT_EQ(runs[0], runs[1]);
  EXPECT_EQ(runs[0], runs[2]);
}

TEST(RadialBasis, MergesRepeatedCentersAndAveragesTheirValues) {
  std::vector<Vec3d> centers = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}, {10, 10, 10}, {10, 0, 0}};
  std::vector<double> values = {0, 1, 2, 3, 5, 1};
  EXPECT_EQ(RadialBasis::fit(centers, values).center_count(), 5u);
  values[5] = 1.5;
  EXPECT_THROW(RadialBasis::fit(centers, values), InvalidInput);
  const RadialBasis smoothed = RadialBasis::fit(centers, values, {.smoothing = 1e-12});
  EXPECT_NEAR(smoothed.value({10, 0, 0}), 1.25, 1e-6);
}

TEST(RadialBasis, SmoothingPullsNoiseTowardsThePolynomial) {
  const std::vector<Vec3d> centers = random_points(200, 10, {0, 0, 0}, {10, 10, 10});
  std::vector<double> values;
  for (std::size_t i = 0; i < centers.size(); ++i) values.push_back(centers[i].x() + (i % 2 ? 0.5 : -0.5));
  double worst = 0;
  const RadialBasis basis = RadialBasis::fit(centers, values, {.smoothing = 1e4});
  for (const Vec3d& c : centers) worst = std::max(worst, std::abs(basis.value(c) - c.x()));
  EXPECT_LT(worst, 0.2);
  EXPECT_GT(worst, 0);
}

TEST(RadialBasis, TakesCentersInAPlaneOnALineAndAlone) {
  std::vector<Vec3d> centers;
  std::vector<double> values;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 5; ++j) {
      centers.push_back({double(i), double(j), 7});
      values.push_back(i - 2 * j);
    }
  for (const Kernel kernel : all_kernels) {
    const RadialBasis plane = RadialBasis::fit(centers, values, {.kernel = kernel});
    EXPECT_NEAR(plane.value({2.5, 1.5, 7}), -0.5, 1e-9);
    EXPECT_LT((plane.gradient({2.5, 1.5, 7}) - Vec3d(1, -2, 0)).norm(), 1e-9);
  }
  const std::vector<Vec3d> line = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  EXPECT_NEAR(RadialBasis::fit(line, std::vector<double>{0, 1, 2}).value({1.5, 1.5, 1.5}), 1.5, 1e-12);
  EXPECT_DOUBLE_EQ(RadialBasis::fit(std::vector<Vec3d>{{1, 2, 3}}, std::vector<double>{4}).value({9, 9, 9}), 4);
}

TEST(RadialBasis, RefusesUnusableInput) {
  const std::vector<Vec3d> none;
  EXPECT_THROW(RadialBasis::fit(none, {}), InvalidInput);
  const std::vector<Vec3d> centers = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_THROW(RadialBasis::fit(centers, std::vector<double>{1}), InvalidInput);
  EXPECT_THROW(RadialBasis::fit(centers, std::vector<double>{1, std::nan("")}), InvalidInput);
  const std::vector<Vec3d> infinite = {{0, 0, 0}, {INFINITY, 0, 0}};
  EXPECT_THROW(RadialBasis::fit(infinite, std::vector<double>{1, 2}), InvalidInput);
}
