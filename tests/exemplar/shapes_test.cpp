// Shapes: closed, outward, clean, of the wanted count, on their zero set, near-uniform.
#include "volume/base/error.h"
#include "volume/exemplar/shapes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pith {
namespace {

class Shape : public ::testing::TestWithParam<std::string> {};

TEST_P(Shape, IsCleanAtEveryCount) {
  for (const int wanted : {1200, 3000, 8000}) {
    const TriMesh mesh = named_shape(GetParam(), wanted);
    EXPECT_NEAR(double(mesh.triangle_count()), wanted, (wanted < 2000 ? 0.1 : 0.06) * wanted);
    const SurfaceDefects defects = surface_defects(mesh);
    EXPECT_TRUE(defects.clean()) << wanted << ": " << defects.summary();
    EXPECT_EQ(defects.shells, 1u);
    EXPECT_EQ(mesh.vertex_count(), mesh.triangle_count() / 2 + 2); // a sphere's Euler number
    EXPECT_GT(signed_volume(mesh), 0);
  }
}

TEST_P(Shape, LiesOnItsFunctionWithNearUniformTriangles) {
  if (GetParam() == "kiwi") return; // kiwi_surface_test.cpp
  const ImplicitShape shape = implicit_shape(GetParam());
  const TriMesh mesh = named_shape(GetParam(), 8000);
  std::vector<double> edge;
  double worst = 0, smallest_angle = 4;
  for (const auto& c : mesh.corner)
    for (int i = 0; i < 3; ++i) {
      const Vec3d a = mesh.position[c[i]], u = mesh.position[c[(i + 1) % 3]] - a,
                  v = mesh.position[c[(i + 2) % 3]] - a;
      edge.push_back(u.norm());
      smallest_angle = std::min(smallest_angle, std::acos(u.dot(v) / (u.norm() * v.norm())));
    }
  std::sort(edge.begin(), edge.end());
  const double middle = edge[edge.size() / 2];
  for (const Vec3d& p : mesh.position) {
    Vec3d gradient;
    for (int a = 0; a < 3; ++a)
      gradient[a] = (shape.value(p + 1e-4 * Vec3d::Unit(a)) - shape.value(p - 1e-4 * Vec3d::Unit(a))) / 2e-4;
    worst = std::max(worst, std::fabs(shape.value(p)) / gradient.norm());
  }
  EXPECT_LT(worst, 0.01 * middle) << "mm from the surface";
  EXPECT_GT(edge[edge.size() / 100] / middle, 0.4);
  EXPECT_LT(edge[edge.size() * 99 / 100] / middle, 1.8);
  EXPECT_GT(smallest_angle, 0.17); // 10°
}

INSTANTIATE_TEST_SUITE_P(All, Shape, ::testing::ValuesIn(shape_names()), [](const auto& info) { return info.param; });

TEST(Shapes, SameEveryTime) {
  const TriMesh a = named_shape("carrot", 900), b = named_shape("carrot", 900);
  EXPECT_TRUE(a.position == b.position);
  EXPECT_TRUE(a.corner == b.corner);
}

TEST(Shapes, ABallIsABall) {
  const TriMesh ball = implicit_surface(
      {[](const Vec3d& p) { return p.squaredNorm() - 100; }, {-11, -11, -11}, {11, 11, 11}}, 4000, "ball");
  for (const Vec3d& p : ball.position) EXPECT_NEAR(p.norm(), 10, 1e-6);
  EXPECT_NEAR(signed_volume(ball), 4188.8, 20); // chords lie inside
}

TEST(Shapes, ATorusKeepsItsHole) {
  const auto value = [](const Vec3d& p) { return std::hypot(std::hypot(p.x(), p.y()) - 20, p.z()) - 6; };
  const TriMesh torus = implicit_surface({value, {-28, -28, -8}, {28, 28, 8}}, 3000, "torus");
  EXPECT_TRUE(surface_defects(torus).clean());
  EXPECT_EQ(torus.vertex_count(), torus.triangle_count() / 2);
}

TEST(Shapes, BadInputIsRefused) {
  EXPECT_THROW(named_shape("teapot", 1000), InvalidInput);
  EXPECT_THROW(named_shape("carrot", 99), InvalidInput);
  EXPECT_THROW(named_shape("carrot", 1000001), InvalidInput);
  const auto outside = [](const Vec3d&) { return 1.0; };
  EXPECT_THROW(implicit_surface({outside, {-1, -1, -1}, {1, 1, 1}}, 1000, "nothing"), InvalidInput);
  const auto large = [](const Vec3d& p) { return p.norm() - 2; };
  EXPECT_THROW(implicit_surface({large, {-1, -1, -1}, {1, 1, 1}}, 1000, "too large"), InvalidInput);
}

} // namespace
} // namespace pith
