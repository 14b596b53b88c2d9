// Warping a clump along its frames, and how fast frames turn.
#include "tests/support/tet_grid.h"
#include "volume/base/random.h"
#include "volume/lap/turning.h"
#include "volume/lap/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pith {
namespace {

TEST(Warp, FindsTheMapWhoseGradientsItIsGiven) {
  // A linear map is found whatever the start, up to the pin.
  const TetMesh mesh = tet_grid(3, 3, 3, 1.0);
  const Simplices simplices = simplices_of(mesh, 0);
  Clump clump;
  for (TetId t : all_ids<TetId>(mesh.tet_count())) {
    clump.simplex.push_back(t);
    clump.confidence.push_back(1);
    for (VertexId v : mesh.corner[t]) clump.corner.push_back(v);
  }
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) clump.vertex.push_back(v);
  Random random(1);
  for (std::size_t i = 0; i < 3 * mesh.vertex_count(); ++i) clump.coordinate.push_back(random.uniform());
  const Vec3d gradients[3] = {{0.3, 0.1, 0}, {0, 0.2, -0.1}, {0.05, 0, 0.4}};
  std::vector<Vec3d> target;
  for (std::size_t s = 0; s < clump.simplex.size(); ++s) target.insert(target.end(), gradients, gradients + 3);
  warp(simplices, clump, target, simplices.measure, {true, true, true}, {0.5, 0.5, 0.5}, {0.25f, 0.25f, 0.25f, 0.25f},
       {.tolerance = 1e-10});
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    for (int a = 0; a < 3; ++a)
      EXPECT_NEAR(clump.coordinate[3 * v + a],
                  0.5 + gradients[a].dot(mesh.position[VertexId(v)] - barycenter(mesh, TetId(0))), 1e-7);
}

/// Around the z axis, which lies outside a grid of 8 × 4 × 2: columns R (around), S (inwards), T.
Mat3d polar_frame(const Vec3d& at) {
  const Vec3d inwards = -Vec3d(at.x(), at.y(), 0).normalized();
  Mat3d frame;
  frame << inwards.cross(Vec3d::UnitZ()), inwards, Vec3d::UnitZ();
  return frame;
}

/// Median angle (degrees) between the axis around and the gradient of the coordinate that a warp finds for it.
double angle_around(float length_weight) {
  TetMesh mesh = tet_grid(16, 16, 2, 0.5);
  for (VertexId v : all_ids<VertexId>(mesh.vertex_count())) mesh.position[v] += Vec3d(1.5, -4, 0);
  const Simplices simplices = simplices_of(mesh, 0);
  Clump clump;
  clump.axes = 1;
  std::vector<Vec3d> target;
  for (TetId t : all_ids<TetId>(mesh.tet_count())) {
    clump.simplex.push_back(t);
    clump.confidence.push_back(1);
    clump.length_weight.push_back(length_weight);
    for (VertexId v : mesh.corner[t]) clump.corner.push_back(v);
    target.push_back(polar_frame(barycenter(mesh, t)).col(0));
  }
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) clump.vertex.push_back(v);
  clump.coordinate.assign(mesh.vertex_count(), 0.0);
  warp(simplices, clump, target, simplices.measure, {true, false, false}, {0.5, 0, 0}, {0.25f, 0.25f, 0.25f, 0.25f},
       {.tolerance = 1e-6, .max_iterations = 4000});
  std::vector<double> angle;
  for (std::size_t s = 0; s < target.size(); ++s) {
    Vec3d gradient = Vec3d::Zero();
    for (int i = 0; i < 4; ++i) gradient += clump.coordinate[clump.corner[4 * s + i]] * simplices.gradient[4 * s + i];
    angle.push_back(180 / std::numbers::pi * std::acos(gradient.normalized().dot(target[s])));
  }
  std::nth_element(angle.begin(), angle.begin() + angle.size() / 2, angle.end());
  return angle[angle.size() / 2];
}

TEST(Warp, FollowsDirectionsThatSpreadWhereLengthsCountLittle) {
  // The angle about the axis has exactly these directions, but no unit length anywhere but at one radius.
  const double alike = angle_around(1), tenth = angle_around(0.1f), hundredth = angle_around(0.01f);
  EXPECT_LT(tenth, 0.4 * alike) << alike;
  EXPECT_LT(hundredth, 0.5 * tenth) << tenth;
}

TEST(Turning, IsTheLargestAngleToANeighbour) {
  TetMesh mesh = tet_grid(8, 8, 2, 1.0);
  for (VertexId v : all_ids<VertexId>(mesh.vertex_count())) mesh.position[v] += Vec3d(1.5, -4, 0);
  const Simplices simplices = simplices_of(mesh, 0);
  std::vector<Mat3d> axes;
  for (TetId t : all_ids<TetId>(mesh.tet_count())) axes.push_back(polar_frame(barycenter(mesh, t)));
  std::vector<std::uint8_t> singular(mesh.tet_count(), 0);
  singular[7] = 1;
  const std::vector<float> turning = turning_of(simplices, {.axes = axes}, singular);
  EXPECT_NEAR(turning[7], std::numbers::pi, 1e-6);
  for (std::size_t s = 0; s < turning.size(); ++s) {
    if (s == 7) continue;
    double largest = 0;
    const double own = std::atan2(simplices.center[s].y(), simplices.center[s].x());
    for (int k = 0; k < 4; ++k)
      if (const std::uint32_t next = simplices.neighbor[4 * s + k]; next != Simplices::none)
        largest =
            std::max(largest, std::abs(own - std::atan2(simplices.center[next].y(), simplices.center[next].x())));
    EXPECT_NEAR(turning[s], largest, 1e-4);
  }
  EXPECT_EQ(turning_of(simplices, {.axes = {}, .fixed_axes = 0}, {}), std::vector<float>(mesh.tet_count(), 0.0f));
}

} // namespace
} // namespace pith
