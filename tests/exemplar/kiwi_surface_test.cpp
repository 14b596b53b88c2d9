// The kiwi's outer shape: closed, outward, of the wanted size and count, near-uniform.
#include "volume/base/error.h"
#include "volume/exemplar/kiwi_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pith {
namespace {

class KiwiSurface : public ::testing::TestWithParam<int> {};

TEST_P(KiwiSurface, IsCleanAndNearUniform) {
  const int wanted = GetParam();
  const TriMesh mesh = kiwi_surface(wanted);
  EXPECT_NEAR(double(mesh.triangle_count()), wanted, 0.05 * wanted);

  const SurfaceDefects defects = surface_defects(mesh);
  EXPECT_TRUE(defects.clean()) << defects.summary();
  EXPECT_EQ(defects.shells, 1u);
  EXPECT_EQ(mesh.vertex_count(), mesh.triangle_count() / 2 + 2); // a sphere's Euler number
  EXPECT_GT(signed_volume(mesh), 0.9 * 82500);
  EXPECT_LT(signed_volume(mesh), 1.01 * 83000);

  std::vector<double> edge;
  std::vector<int> valence(mesh.vertex_count(), 0);
  double smallest_angle = 4;
  for (const auto& c : mesh.corner)
    for (int i = 0; i < 3; ++i) {
      const Vec3d a = mesh.position[c[i]], u = mesh.position[c[(i + 1) % 3]] - a,
                  v = mesh.position[c[(i + 2) % 3]] - a;
      edge.push_back(u.norm());
      smallest_angle = std::min(smallest_angle, std::acos(u.dot(v) / (u.norm() * v.norm())));
      ++valence[c[i].value];
    }
  std::sort(edge.begin(), edge.end());
  EXPECT_GT(edge[edge.size() / 100] / edge[edge.size() / 2], 0.5);
  EXPECT_LT(edge[edge.size() * 99 / 100] / edge[edge.size() / 2], 1.6);
  EXPECT_LT(edge.back() / edge.front(), 3.2);
  EXPECT_GT(smallest_angle, 0.50); // 29°
  EXPECT_GE(*std::min_element(valence.begin(), valence.end()), 5);
  EXPECT_LE(*std::max_element(valence.begin(), valence.end()), 7);

  // Every vertex lies on the shape, the ends on the axis.
  for (const Vec3d& p : mesh.position) EXPECT_NEAR(p.norm(), kiwi_surface_radius(p.normalized()), 1e-9);
  EXPECT_NEAR(mesh.position.front().head<2>().norm(), 0, 1e-9);
  EXPECT_NEAR(mesh.position.back().head<2>().norm(), 0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Counts, KiwiSurface, ::testing::Values(150, 1000, 1234, 4000, 20000));

TEST(KiwiSurfaceShape, HasAKiwisSize) {
  const Vec3d extent = bounds_of(kiwi_surface(20000)).extent();
  EXPECT_NEAR(extent.x(), 50, 0.5);
  EXPECT_NEAR(extent.y(), 46, 0.5);
  EXPECT_NEAR(extent.z(), 62, 0.5);
}

TEST(KiwiSurfaceShape, IsSmooth) {
  // Steps of a thousandth of a radian turn the radius by less than a tenth of that angle's arc times the slope bound.
  for (int i = 0; i < 2000; ++i) {
    const double polar = 3.14159 * (i + 0.5) / 2000, around = 0.37 * i;
    const auto radius = [&](double p) {
      return kiwi_surface_radius({std::sin(p) * std::cos(around), std::sin(p) * std::sin(around), std::cos(p)});
    };
    EXPECT_LT(std::fabs(radius(polar + 1e-3) - radius(polar)) / 1e-3, 1.1 * radius(polar));
    // Second differences bound the curvature: no crease.
    const double bend = (radius(polar + 1e-3) - 2 * radius(polar) + radius(polar - 1e-3)) / 1e-6;
    EXPECT_LT(std::fabs(bend), 400) << "polar angle " << polar;
  }
}

TEST(KiwiSurfaceShape, SameEveryTime) {
  const TriMesh a = kiwi_surface(1200), b = kiwi_surface(1200);
  EXPECT_TRUE(a.position == b.position);
  EXPECT_TRUE(a.corner == b.corner);
}

TEST(KiwiSurfaceShape, BadCountsAreRefused) {
  EXPECT_THROW(kiwi_surface(99), InvalidInput);
  EXPECT_THROW(kiwi_surface(-1), InvalidInput);
  EXPECT_THROW(kiwi_surface(1000001), InvalidInput);
}

} // namespace
} // namespace pith
