// Reliefs: what rays meet of a displaced skin.
#include "tests/raytrace/scenes.h"
#include "volume/base/random.h"
#include "volume/cut/cut.h"
#include "volume/layer/relief.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pith {
namespace {

using namespace testing;

/// Heights from 0.5 mm at the low z to 2.5 mm at the high z.
Root sloping_ball() {
  return root_of(tet_ball(8, 10), colorful(), std::array<double, 8>{0.5, 0.5, 0.5, 0.5, 2.5, 2.5, 2.5, 2.5});
}

TEST(Relief, StandsOnTheLowestHeight) {
  const Root root = sloping_ball();
  const Relief relief(root);
  ASSERT_TRUE(relief.exists());
  const Locator& locator = root.locator();
  for (const double z : {-9.0, 0.0, 4.0, 9.0}) {
    const Vec3d x(0.3, 0.2, z);
    // Texel centres lie at a quarter and three quarters; beyond them the exemplar is clamped.
    const double part = std::clamp((z + 10) / 20, 0.25, 0.75);
    EXPECT_NEAR(relief.at({.position = x, .region = 0, .facet = {}, .hint = locator.owner(x)}), 4 * (part - 0.25),
                0.03);
  }
  EXPECT_FALSE(Relief(root_of(tet_ball(4, 10), colorful())).exists());
  EXPECT_FALSE(Relief(root_of(tet_ball(4, 10), colorful(), std::array<double, 8>{1, 1, 1, 1, 1, 1, 1, 1})).exists());
}

TEST(Relief, IsMetWhereItStandsAndColouredWhereItLies) {
  const Root root = sloping_ball();
  const Pieces pieces = whole_piece(root.model().mesh);
  SceneOptions options = matte();
  options.displacement.max_edge = 0.5;
  const Scene scene(root, pieces, options);
  const Relief relief(root);
  for (int k = 0; k < 200; ++k) {
    Random random(5, k);
    const Vec3d towards =
        -Vec3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1) + 0.01).normalized();
    const Hit hit = scene.nearest({-30 * towards, towards});
    ASSERT_TRUE(hit.exists());
    const double height = relief.at({.position = hit.rest, .region = 0, .facet = hit.tag.facet(), .hint = hit.root});
    EXPECT_NEAR((hit.position - hit.rest).norm(), height, 0.06);
    EXPECT_LT(hit.rest.norm(), 10 + 1e-9);
    EXPECT_GT(hit.rest.norm(), 9.5);
    EXPECT_GT(hit.smooth.dot(-towards), 0.9); // it faces outwards, inclined a little
    const Material material =
        material_at(root, {.position = hit.rest, .region = 0, .facet = hit.tag.facet(), .hint = hit.root});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(scene.material(hit, 0).albedo[c], material.value[c], 1e-6);
    EXPECT_GT((hit.lifted - hit.position).dot(hit.normal), 0);
    EXPECT_FALSE(scene.occluded({hit.lifted, -towards}));
  }
}

TEST(Relief, UnmovedHalvesShowNoWallsBetweenThemAndPartedOnesShowNoGap) {
  const Root root = sloping_ball();
  Pieces pieces = whole_piece(root.model().mesh);
  cut(pieces, root.model().mesh, root.model().boundary, *level_set_of(PlaneCut{{1, 0, 0}, 0.3}));
  SceneOptions options = matte();
  options.displacement.max_edge = 0.5;
  const Scene together(root, pieces, options);
  for (const Vec3d& p : together.points()) EXPECT_GT(p.norm(), 9.4); // nothing inside
  pieces.piece[1].placement.translation = {40, 0, 0};
  const Scene parted(root, pieces, options);
  // Along the cut's normal, just inside the moved rim: the section or the wall is met, never the inside of the skin.
  const auto& seen = parted;
  const int inwards = pieces.piece.size() == 2 ? 1 : 0;
  ASSERT_EQ(inwards, 1);
  for (int k = 0; k < 400; ++k) {
    const double angle = 0.0157 * k;
    for (const double r : {5.0, 9.0, 9.6, 9.9}) {
      const Vec3d from(20, r * std::cos(angle), r * std::sin(angle));
      const Hit hit = seen.nearest({from, {-1, 0, 0}});
      if (!hit.exists()) continue; // where the relief is low
      EXPECT_NEAR(hit.position.x(), 0.3, 1.5);
      EXPECT_GT(hit.normal.x(), 0) << from.transpose();
    }
  }
}

TEST(Relief, OfScaleZeroLeavesEveryHitAsItWas) {
  const Root with = sloping_ball(), without = root_of(tet_ball(8, 10), colorful());
  const Pieces pieces = whole_piece(with.model().mesh);
  SceneOptions options = matte();
  options.displacement.scale = 0;
  const Scene a(with, pieces, options), b(without, pieces, matte());
  EXPECT_EQ(a.triangle_count(), b.triangle_count());
  for (int k = 0; k < 50; ++k) {
    Random random(6, k);
    const Vec3d towards = Vec3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    const Hit x = a.nearest({-30 * towards, towards}), y = b.nearest({-30 * towards, towards});
    EXPECT_EQ(x.position, y.position);
    EXPECT_EQ(x.smooth, y.smooth);
    EXPECT_EQ(x.lifted, y.lifted);
  }
}

} // namespace
} // namespace pith
