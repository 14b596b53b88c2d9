// Depth held by parts of a region's boundary: the outside, and interfaces with other regions.
#include "tests/support/tet_grid.h"
#include "volume/base/error.h"
#include "volume/field/depth.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pith {
namespace {

/// A box of three layers along z: regions 0, 1 and 2, each two cubes high.
struct Layers {
  TetMesh mesh = tet_grid(4, 4, 6);
  Boundary boundary;
  Layers() {
    for (const TetId t : all_ids<TetId>(mesh.tet_count()))
      mesh.region[t] = static_cast<std::int32_t>(barycenter(mesh, t).z() / 2);
    boundary = boundary_of(mesh);
  }
  DepthField depth(std::int32_t region, const std::vector<DepthConstraint>& constraints) const {
    return depth_field(mesh, boundary, region, constraints, "depth");
  }
  std::string refusal(std::int32_t region, const std::vector<DepthConstraint>& constraints) const {
    try {
      depth(region, constraints);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "accepted";
  }
};

DepthConstraint interface_with(std::int32_t region, double value) {
  DepthConstraint result;
  result.value = value;
  result.interface = region;
  return result;
}
DepthConstraint outside(double value) {
  DepthConstraint result;
  result.value = value;
  result.outside = true;
  return result;
}

TEST(DepthParts, ALayerRunsFromOneInterfaceToTheOther) {
  const Layers layers;
  const DepthField depth = layers.depth(1, {interface_with(0, 0), interface_with(2, 1)});
  for (const VertexId v : all_ids<VertexId>(layers.mesh.vertex_count())) {
    const double z = layers.mesh.position[v].z();
    if (z < 2 || z > 4) continue;
    EXPECT_NEAR(depth.value[v], (z - 2) / 2, z == 3 ? 0.03 : 0); // the free sides do not pull it
  }
  for (const TetId t : all_ids<TetId>(layers.mesh.tet_count()))
    EXPECT_LT((depth.gradient[t] - (layers.mesh.region[t] == 1 ? Vec3d(0, 0, 0.5) : Vec3d(0, 0, 0))).norm(), 0.1);
}

TEST(DepthParts, WhereTheOutsideMeetsAnInterfaceTheRimIsFree) {
  const Layers layers;
  const DepthField depth = layers.depth(0, {outside(0), interface_with(1, 1)});
  int rim = 0;
  for (const VertexId v : all_ids<VertexId>(layers.mesh.vertex_count())) {
    const Vec3d& x = layers.mesh.position[v];
    const bool on_side = x.x() == 0 || x.x() == 4 || x.y() == 0 || x.y() == 4;
    if (x.z() == 2 && on_side) {
      ++rim;
      EXPECT_GT(depth.value[v], 0.05);
      EXPECT_LT(depth.value[v], 0.95);
    } else if (x.z() == 2) {
      EXPECT_EQ(depth.value[v], 1.0f);
    } else if (x.z() < 2 && (on_side || x.z() == 0)) {
      EXPECT_EQ(depth.value[v], 0.0f);
    }
  }
  EXPECT_EQ(rim, 16);
}

TEST(DepthParts, TheSkinIsTheOutsideAndAllInterfaces) {
  const Layers layers;
  DepthConstraint skin;
  skin.skin = true;
  DepthConstraint core;
  core.value = 1;
  core.stroke = {{2, 2, 3}};
  const DepthField whole = layers.depth(1, {skin, core});
  const DepthField parts = layers.depth(1, {outside(0), interface_with(0, 0), interface_with(2, 0), core});
  EXPECT_EQ(whole.value, parts.value);
}

TEST(DepthParts, WhatNamesNoPlaceIsRefused) {
  const Layers layers;
  EXPECT_NE(layers.refusal(0, {interface_with(2, 0), outside(1)}).find("region 0 does not touch region 2"),
            std::string::npos);
  EXPECT_NE(layers.refusal(0, {outside(0), interface_with(0, 1)}).find("does not touch region 0"), std::string::npos);
  Layers inside;
  for (const TetId t : all_ids<TetId>(inside.mesh.tet_count())) {
    const Vec3d x = barycenter(inside.mesh, t);
    inside.mesh.region[t] = x.x() > 1 && x.x() < 3 && x.y() > 1 && x.y() < 3 && x.z() > 1 && x.z() < 5;
  }
  inside.boundary = boundary_of(inside.mesh);
  EXPECT_NE(inside.refusal(1, {outside(0), interface_with(0, 1)}).find("region 1 has no outside"), std::string::npos);
  DepthConstraint skin;
  skin.skin = true;
  EXPECT_NE(layers.refusal(1, {skin, interface_with(0, 1)}).find("two constraints ask for depths 0 and 1"),
            std::string::npos);
}

} // namespace
} // namespace pith
