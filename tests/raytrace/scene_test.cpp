#include "raytrace/scene.h"

#include "raytrace/framing.h"
#include "tests/raytrace/scenes.h"
#include "volume/base/error.h"
#include "volume/base/random.h"
#include "volume/cut/arrange.h"

#include <gtest/gtest.h>

namespace pith {
namespace {

using testing::matte;
using testing::root_of;

Vec3d random_direction(Random& random) {
  while (true) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    const Vec3d v(x, y, random.uniform(-1, 1));
    if (v.squaredNorm() > 0.01 && v.squaredNorm() < 1) return v.normalized();
  }
}

/// The nearest triangle by trying all of them, in double.
double nearest_by_hand(const std::vector<PieceSurface>& surfaces, const Pieces& pieces, const SceneRay& ray) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < surfaces.size(); ++p) {
    const Rigid& place = pieces.piece[p].placement;
    for (const auto& t : surfaces[p].triangle) {
      const Vec3d a = place(surfaces[p].position[t.corner[0]]), ab = place(surfaces[p].position[t.corner[1]]) - a,
                  ac = place(surfaces[p].position[t.corner[2]]) - a;
      const Vec3d h = ray.direction.cross(ac);
      const double det = ab.dot(h);
      if (std::abs(det) < 1e-14) continue;
      const Vec3d s = ray.origin - a;
      const double u = s.dot(h) / det, v = ray.direction.dot(s.cross(ab)) / det, d = ac.dot(s.cross(ab)) / det;
      if (u >= 0 && v >= 0 && u + v <= 1 && d > 0) nearest = std::min(nearest, d);
    }
  }
  return nearest;
}

TEST(Scene, FindsWhatTryingEveryTriangleFinds) {
  const Root root = root_of(tet_ball(8, 20), Vec3d(0.5, 0.5, 0.5));
  Pieces pieces = whole_piece(root.model().mesh);
  const auto result =
      cut(pieces, root.model().mesh, root.model().boundary, *level_set_of(PlaneCut{{0.2, 1, 0.3}, 1.7}));
  pieces.piece[1].placement.rotation = Eigen::AngleAxisd(0.7, Vec3d(1, 2, 3).normalized()).toRotationMatrix();
  pieces.piece[1].placement.translation = {30, 5, -4};
  const Scene scene(root, pieces, matte());
  std::vector<PieceSurface> surfaces;
  for (std::uint32_t p = 0; p < 2; ++p)
    surfaces.push_back(surface_of(pieces, p, root.model().mesh, root.model().boundary));
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    Random random(1, i);
    const Vec3d from = Vec3d(15, 0, 0) + 90 * random_direction(random);
    const Vec3d at = Vec3d(15, 0, 0) + 28 * random.uniform() * random_direction(random);
    const SceneRay ray{from, (at - from).normalized()};
    const Hit hit = scene.nearest(ray);
    const double expected = nearest_by_hand(surfaces, pieces, ray);
    ASSERT_EQ(hit.exists(), std::isfinite(expected)) << i;
    EXPECT_EQ(scene.occluded(ray), hit.exists());
    if (!hit.exists()) continue;
    ++hits;
    EXPECT_NEAR(hit.distance, expected, 1e-4);
    EXPECT_LT((ray.origin + hit.distance * ray.direction - hit.position).norm(), 1e-4);
    EXPECT_LT((pieces.piece[hit.piece].placement(hit.rest) - hit.position).norm(), 1e-12);
    EXPECT_LT(hit.normal.dot(ray.direction), 0);
    EXPECT_GT(hit.normal.dot(hit.smooth), 0.8);
    EXPECT_GT(hit.normal.dot(hit.lifted - hit.position), 0);
    EXPECT_LT((hit.lifted - hit.position).norm(), 1);
  }
  EXPECT_GT(hits, 1000);
}

/// Where the surfaces of two pieces coincide, the lowest piece is seen, whatever the tree meets first.
TEST(Scene, TiesGoToTheLowestPiece) {
  const Root root = root_of(tet_grid(8, 3, 3, 1.1), Vec3d(0.5, 0.5, 0.5));
  for (const double shift : {-2.2, -1.3}) {
    Pieces pieces = whole_piece(root.model().mesh);
    cut(pieces, root.model().mesh, root.model().boundary, *level_set_of(PlaneCut{{1, 0, 0}, 4.4}));
    pieces.piece[1].placement.translation = {shift, 0, 0};
    const Scene scene(root, pieces, matte());
    int shared = 0;
    for (int i = 0; i < 2000; ++i) {
      Random random(6, i);
      const Vec3d at(random.uniform(0, 6.5), random.uniform(0.1, 3.2), 3.3);
      const Vec3d from = at + Vec3d(random.uniform(-20, 20), random.uniform(-20, 20), 30);
      const Hit hit = scene.nearest({from, (at - from).normalized()});
      ASSERT_TRUE(hit.exists());
      if (hit.position.z() < 3.3 - 1e-6 || std::abs(hit.position.x() - 4.4) < 1e-3) continue;
      EXPECT_EQ(hit.piece, hit.position.x() < 4.4 ? 0u : 1u);
      shared += hit.position.x() > 4.4 + shift && hit.position.x() < 4.4;
    }
    EXPECT_GT(shared, 300);
  }
}

TEST(Scene, UnmovedSectionsAreNotThere) {
  const Root root = root_of(tet_ball(8, 20), Vec3d(0.5, 0.5, 0.5));
  Pieces pieces = whole_piece(root.model().mesh);
  cut(pieces, root.model().mesh, root.model().boundary, *level_set_of(PlaneCut{{0, 1, 0}, 1.3}));
  EXPECT_EQ(Scene(root, pieces, matte()).section_area(), 0);
  // From inside, nothing stands between one half and the other.
  const Scene together(root, pieces, matte());
  EXPECT_FALSE(together.occluded({{1, -3, 2}, {0, 1, 0}, 10}));
  pieces.piece[1].placement.translation = {0, 2, 0};
  const Scene apart(root, pieces, matte());
  EXPECT_TRUE(apart.occluded({{1, -3, 2}, {0, 1, 0}, 10}));
  const double radius = std::sqrt(20 * 20 - 1.3 * 1.3);
  EXPECT_NEAR(apart.section_area(), 2 * std::numbers::pi * radius * radius, 0.1 * apart.section_area());
}

TEST(Scene, SectionsHaveTheCutsNormals) {
  const Root root = root_of(tet_ball(10, 20), Vec3d(0.5, 0.5, 0.5));
  Pieces pieces = whole_piece(root.model().mesh);
  const SphereCut sphere{{0, 30, 0}, 25};
  cut(pieces, root.model().mesh, root.model().boundary, *level_set_of(sphere));
  const std::uint32_t outside =
      piece_at(pieces, root.model().mesh, root.locator().locate(Vec3d(0, -10, 0)).tet, Vec3d(0, -10, 0));
  keep_pieces(pieces, root.model().mesh, std::vector<std::uint32_t>{outside});
  const Scene scene(root, pieces, matte());
  int sections = 0;
  for (int i = 0; i < 400; ++i) {
    Random random(2, i);
    const double x = random.uniform(-8, 8);
    const Hit hit = scene.nearest({{x, 60, random.uniform(-8, 8)}, {0, -1, 0}});
    ASSERT_TRUE(hit.exists());
    if (!hit.tag.is_section()) continue;
    ++sections;
    EXPECT_GT(hit.smooth.dot((sphere.center - hit.position).normalized()), 0.99); // outwards: into the hollow
  }
  EXPECT_GT(sections, 200);
}

TEST(Scene, SkinNormalsAreSmoothOnABallAndSharpOnABox) {
  const Root ball = root_of(tet_ball(12, 20), Vec3d(0.5, 0.5, 0.5));
  const Scene round(ball, whole_piece(ball.model().mesh), matte());
  const Root box = root_of(tet_grid(3, 3, 3, 5), Vec3d(0.5, 0.5, 0.5));
  const Scene sharp(box, whole_piece(box.model().mesh), matte());
  for (int i = 0; i < 500; ++i) {
    Random random(3, i);
    const Vec3d w = random_direction(random);
    const Hit on_ball = round.nearest({60 * w, -w});
    ASSERT_TRUE(on_ball.exists());
    EXPECT_GT(on_ball.smooth.dot(on_ball.position.normalized()), 0.995);
    const Hit on_box = sharp.nearest({Vec3d(7.5, 7.5, 7.5) + 60 * w, -w});
    ASSERT_TRUE(on_box.exists());
    EXPECT_GT(on_box.smooth.dot(on_box.normal), 1 - 1e-6);
  }
}

TEST(Scene, StandsOnItsGround) {
  const Root root = root_of(tet_ball(6, 20), Vec3d(0.5, 0.5, 0.5));
  SceneOptions options = matte();
  options.ground.on = true;
  options.up = {0, 0, 2};
  const Scene scene(root, whole_piece(root.model().mesh), options);
  EXPECT_NEAR(scene.ground_height(), -20, 1e-9);
  const Hit hit = scene.nearest({{100, 0, 80}, Vec3d(0, 0.1, -1).normalized()});
  ASSERT_TRUE(hit.is_ground());
  EXPECT_NEAR(hit.position.z(), -20, 1e-9);
  EXPECT_FALSE(scene.nearest({{100, 0, -80}, {0, 0, 1}}).exists()); // from below there is none
  EXPECT_TRUE(scene.occluded({{100, 0, 80}, {0, 0, -1}}));
  EXPECT_FALSE(scene.occluded({{100, 0, 80}, {0, 0, -1}, 50}));
}

TEST(Scene, FarAwayFromTheOriginNothingChanges) {
  const Root root = root_of(tet_ball(8, 20), Vec3d(0.5, 0.5, 0.5));
  Pieces pieces = whole_piece(root.model().mesh);
  const Scene near(root, pieces, matte());
  const Vec3d far_away(4e6, -3e6, 1e6);
  pieces.piece[0].placement.translation = far_away;
  const Scene far(root, pieces, matte());
  for (int i = 0; i < 500; ++i) {
    Random random(5, i);
    const Vec3d w = random_direction(random);
    const SceneRay ray{60 * w + 25 * random_direction(random), -w};
    const Hit a = near.nearest(ray), b = far.nearest({ray.origin + far_away, ray.direction});
    ASSERT_EQ(a.exists(), b.exists());
    EXPECT_TRUE(!a.exists() || (a.rest - b.rest).norm() < 1e-6);
  }
}

TEST(Framing, EveryPointIsInsideAndTheFrameIsFull) {
  const Root root = root_of(tet_grid(2, 3, 5, 7), Vec3d(0.5, 0.5, 0.5));
  Pieces pieces = whole_piece(root.model().mesh);
  pieces.piece[0].placement.translation = {100, -50, 20};
  const Scene scene(root, pieces, matte());
  for (const double angle : {0.45, 1.2, 0.0})
    for (const double aspect : {0.5, 1.0, 2.0})
      for (const Vec3d& direction : {Vec3d(0, 0, 0), Vec3d(1, 0.3, 0.2), Vec3d(0, 1, 0), Vec3d(-1, -0.2, 3)}) {
        const View view =
            framed_view(scene, {.direction = direction, .vertical_angle = angle, .aspect = aspect, .margin = 0.1});
        double widest = 0, inside = 1;
        for (const Vec3d& p : scene.points()) {
          const Vec2d s = view.project(p);
          inside = std::min(inside, (p - view.eye).dot(view.forward()));
          widest = std::max({widest, std::abs(s.x()) / aspect, std::abs(s.y())});
        }
        EXPECT_GT(inside, 0);
        EXPECT_NEAR(widest, 0.9, 1e-6);
      }
}

/// The chosen view sees the section of a half, however it lies, and the larger free section of two.
TEST(Framing, LooksAtTheSections) {
  const Root root = root_of(tet_ball(8, 20), Vec3d(0.5, 0.5, 0.5));
  SceneOptions options = matte();
  options.ground.on = true;
  for (const Vec3d& normal : {Vec3d(0, 0, 1), Vec3d(0, 0, -1), Vec3d(1, 0, 0.2), Vec3d(0.3, 1, 0)}) {
    Pieces pieces = whole_piece(root.model().mesh);
    cut(pieces, root.model().mesh, root.model().boundary, *level_set_of(PlaneCut{normal, 1}));
    keep_pieces(pieces, root.model().mesh, std::vector<std::uint32_t>{0}); // left: the section faces along the normal
    const View view = framed_view(Scene(root, pieces, options));
    EXPECT_GT(-view.forward().dot(normal.normalized()), 0.6) << normal.transpose();
    EXPECT_LT(view.forward().y(), -0.3);
  }
  Pieces pieces = whole_piece(root.model().mesh);
  cut(pieces, root.model().mesh, root.model().boundary, *level_set_of(PlaneCut{{0, 0, 1}, 0}));
  pieces.piece[0].placement.translation = {60, 0, 0};
  // Piece 1's section looks towards −z, piece 0's towards +z, each past the other.
  EXPECT_GT(std::abs(framed_view(Scene(root, pieces, options)).forward().z()), 0.6);
}

/// Closed forms: a disc straight on, from behind, and at an angle.
TEST(Framing, TheShareOfTheSectionsThatAViewShows) {
  const Root root = root_of(tet_ball(8, 20), Vec3d(0.5, 0.5, 0.5));
  Pieces pieces = whole_piece(root.model().mesh);
  EXPECT_EQ(section_share(Scene(root, pieces, matte()), View{}), 1); // there is none to hide
  cut(pieces, root.model().mesh, root.model().boundary, *level_set_of(PlaneCut{{0, 0, 1}, 1}));
  keep_pieces(pieces, root.model().mesh, std::vector<std::uint32_t>{0});
  const Scene half(root, pieces, matte());
  const auto share = [&](const Vec3d& direction) {
    return section_share(half, framed_view(half, {.direction = direction, .vertical_angle = 0}));
  };
  EXPECT_NEAR(share({0, 0, 1}), 1, 1e-6);
  EXPECT_NEAR(share({0, 0, -1}), 0, 1e-6);
  EXPECT_NEAR(share({std::sqrt(3.0), 0, 1}), 0.5, 1e-6);
  const View near = framed_view(half, {.direction = {0, 0, 1}, .vertical_angle = 1});
  EXPECT_GT(section_share(half, near), 0.8); // its rim is seen aslant
  EXPECT_LT(section_share(half, near), 0.99);
}

/// Halves that face one another across a gap, along several axes: hardly any view shows more than the chosen one.
TEST(Framing, LooksIntoTheGapBetweenHalves) {
  const Root root = root_of(tet_ball(8, 20), Vec3d(0.5, 0.5, 0.5));
  SceneOptions options = matte();
  options.ground.on = true;
  for (const Vec3d& normal : {Vec3d(1, 0, 0), Vec3d(0, 0, 1), Vec3d(0, 1, 0), Vec3d(1, 0.5, -0.7)})
    for (const double gap : {15.0, 40.0}) {
      Pieces pieces = whole_piece(root.model().mesh);
      const CutResult result =
          cut(pieces, root.model().mesh, root.model().boundary, *level_set_of(PlaneCut{normal, 0}));
      spread(pieces, result, root.model().mesh, gap);
      const Scene scene(root, pieces, options);
      const double chosen = section_share(scene, framed_view(scene));
      double best = 0;
      for (int turn = 0; turn < 36; ++turn)
        for (const double rise : {0.15, 0.3, 0.45, 0.6, 0.8, 1.0}) {
          const double angle = turn * 0.1745;
          const Vec3d direction(std::cos(rise) * std::cos(angle), std::sin(rise), std::cos(rise) * std::sin(angle));
          best = std::max(best, section_share(scene, framed_view(scene, {.direction = direction})));
        }
      EXPECT_GT(best, 0.05);
      EXPECT_GT(chosen, 0.8 * best) << normal.transpose() << ", gap " << gap;
    }
}

TEST(Scene, RefusesWhatItCannotShow) {
  const Root root = root_of(tet_grid(1, 1, 1), Vec3d(0.5, 0.5, 0.5));
  const Pieces pieces = whole_piece(root.model().mesh);
  SceneOptions options;
  options.up = Vec3d::Zero();
  EXPECT_THROW(Scene(root, pieces, options), InvalidInput);
  options = {};
  options.skin.roughness = 2;
  EXPECT_THROW(Scene(root, pieces, options), InvalidInput);
  options = {};
  options.section.index = 0.5;
  EXPECT_THROW(Scene(root, pieces, options), InvalidInput);
  Pieces none = pieces;
  none.piece.clear();
  none.label.assign(none.label.size(), Pieces::was_cut);
  EXPECT_THROW(Scene(root, none), InvalidInput);
}

} // namespace
} // namespace pith
