#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"
#include "volume/field/kernel_sum.h"
#include "volume/field/radial_basis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

using namespace pith;

namespace {

/// Points spread over a closed, wavy surface about 90 mm long, a little irregularly.
std::vector<Vec3d> surface_points(int count) {
  std::vector<Vec3d> points;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - 2 * (i + 0.5) / count, r = std::sqrt(1 - z * z);
    const double angle = i * 2.399963229728653 + Random(7, i).uniform(-1, 1) / std::sqrt(count) / std::max(r, 0.05);
    const Vec3d d(r * std::cos(angle), r * std::sin(angle), z);
    const double radius = 20 * (1 + 0.25 * std::sin(3 * d.x() + 1) * std::cos(4 * d.y()) + 0.1 * std::sin(7 * d.z()));
    points.push_back(radius * Vec3d(1.5 * d.x(), d.y(), 0.8 * d.z()));
  }
  return points;
}

double wave(const Vec3d& x) { return std::sin(0.1 * x.x()) * std::cos(0.07 * x.y()) + 0.02 * x.z(); }

std::vector<double> values_at(const std::vector<Vec3d>& points) {
  std::vector<double> values;
  for (const Vec3d& p : points) values.push_back(wave(p));
  return values;
}

/// Places inside, near and a little outside of the surface, and far from it.
std::vector<Vec3d> places(const std::vector<Vec3d>& surface, int count) {
  std::vector<Vec3d> result;
  for (int i = 0; i < count; ++i) {
    Random random(9, i);
    const Vec3d& p = surface[random.below(static_cast<std::uint32_t>(surface.size()))];
    result.push_back(p * random.uniform(0, i % 10 == 9 ? 4.0 : 1.05));
  }
  return result;
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

} // namespace

// The octree serves every pair of points once: with all weights alike, the sum over near and far boxes is the sum.
TEST(KernelSum, EqualsTheSumOverAllPairs) {
  std::vector<Vec3d> points = surface_points(3000);
  for (Vec3d& p : points) p /= 90;
  for (int i = 0; i < 400; ++i) // a dense cluster: leaves of very different size
    points.push_back(points[100] + 1e-3 * Vec3d(Random(1, i).uniform(-1, 1), Random(2, i).uniform(-1, 1), 0));
  std::vector<double> weight;
  for (std::size_t i = 0; i < points.size(); ++i) weight.push_back(Random(3, i).uniform(-1, 1));
  for (const Kernel kernel : {Kernel::biharmonic, Kernel::triharmonic}) {
    KernelSum sum(kernel, points);
    std::vector<double> at_centers(points.size());
    sum.at_centers(weight, at_centers);
    sum.hold(weight);
    const auto exact = [&](const Vec3d& x) {
      double total = 0;
      for (std::size_t j = 0; j < points.size(); ++j) {
        const double r = (x - points[j]).norm();
        total += weight[j] * (kernel == Kernel::biharmonic ? r : r * r * r);
      }
      return total;
    };
    for (std::size_t i = 0; i < points.size(); i += 37) {
      EXPECT_NEAR(at_centers[i], exact(points[i]), 2e-7);
      EXPECT_NEAR(sum.value(points[i]), exact(points[i]), 2e-7);
      const Vec3d outside = 3.5 * points[i];
      EXPECT_NEAR(sum.value(outside), exact(outside), 2e-6);
    }
  }
}

TEST(RadialBasisFast, AgreesWithTheDenseSolution) {
  const std::vector<Vec3d> centers = surface_points(4000);
  const std::vector<double> values = values_at(centers);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  for (const Kernel kernel : {Kernel::biharmonic, Kernel::triharmonic}) {
    const RadialBasis fast = RadialBasis::fit(centers, values, {.kernel = kernel, .method = RadialMethod::fast});
    const RadialBasis dense = RadialBasis::fit(centers, values, {.kernel = kernel, .method = RadialMethod::dense});
    EXPECT_TRUE(fast.fast());
    EXPECT_FALSE(dense.fast());
    EXPECT_LE(fast.residual(), 1e-7 * (*high - *low));
    for (const Vec3d& x : places(centers, 1000)) {
      EXPECT_NEAR(fast.value(x), dense.value(x), 1e-5 * (*high - *low)) << x.transpose();
      EXPECT_LT((fast.gradient(x) - dense.gradient(x)).norm(), 1e-4) << x.transpose();
    }
  }
}

TEST(RadialBasisFast, IsTakenForManyCentersAndHasTheSameBitsOnAnyNumberOfThreads) {
  const std::vector<Vec3d> centers = surface_points(5000);
  const std::vector<double> values = values_at(centers);
  const std::vector<Vec3d> points = places(centers, 500);
  std::vector<double> one(points.size()), all(points.size());
  std::vector<Vec3d> slope(points.size());
  {
    const ThreadLimit limit(1);
    RadialBasis::fit(centers, values).values(points, one);
  }
  const RadialBasis basis = RadialBasis::fit(centers, values);
  EXPECT_TRUE(basis.fast());
  basis.values(points, all);
  basis.gradients(points, slope);
  EXPECT_TRUE(same_bits(one, all));
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(basis.value(points[i]), all[i]);
    EXPECT_EQ(basis.gradient(points[i]), slope[i]);
    constexpr double h = 1e-3;
    for (int a = 0; a < 3; ++a) {
      const Vec3d step = h * Vec3d::Unit(a);
      EXPECT_NEAR(slope[i][a], (basis.value(points[i] + step) - basis.value(points[i] - step)) / (2 * h), 1e-4);
    }
  }
}

TEST(RadialBasisFast, TakesPlanesSmoothingAndNearlyCoincidentCenters) {
  std::vector<Vec3d> plane;
  std::vector<double> values;
  for (int i = 0; i < 1500; ++i) {
    plane.push_back({Random(1, i).uniform(0, 50), Random(2, i).uniform(0, 50), 3});
    values.push_back(wave(plane.back()));
  }
  plane.push_back(plane[0] + Vec3d(1e-5, 0, 0));
  values.push_back(values[0]);
  const RadialBasis flat = RadialBasis::fit(plane, values, {.method = RadialMethod::fast});
  EXPECT_NEAR(flat.value({25, 25, 3}), wave({25, 25, 3}), 1e-3);
  const RadialBasis smoothed = RadialBasis::fit(plane, values, {.smoothing = 1e-3, .method = RadialMethod::fast}),
                    expected = RadialBasis::fit(plane, values, {.smoothing = 1e-3, .method = RadialMethod::dense});
  EXPECT_NEAR(smoothed.value({20, 11, 3}), expected.value({20, 11, 3}), 1e-5);
  EXPECT_THROW(RadialBasis::fit(plane, values, {.kernel = Kernel::thin_plate, .method = RadialMethod::fast}),
               InvalidInput);
}
