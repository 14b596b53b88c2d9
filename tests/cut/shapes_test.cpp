// Level sets: values, gradients, certified signs in balls, and what is refused.
#include "tests/cut/piece_checks.h"
#include "tests/support/tet_grid.h"
#include "tests/support/tri_shapes.h"
#include "volume/base/random.h"

#include <numbers>

namespace pith {
namespace {

Vec3d random_point(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

StrokeCut circle_stroke(bool clockwise, double vertical_angle) {
  StrokeCut stroke;
  stroke.closed = true;
  stroke.view = {.eye = {0, 0, 40}, .target = {0, 0, 0}, .vertical_angle = vertical_angle, .height = 20};
  for (int i = 0; i < 90; ++i) {
    const double angle = (clockwise ? -1 : 1) * 2 * std::numbers::pi * i / 90;
    stroke.point.push_back({0.5 * std::cos(angle), 0.5 * std::sin(angle)});
  }
  return stroke;
}

StrokeCut wave_stroke(double vertical_angle) {
  StrokeCut stroke;
  stroke.view = {.eye = {3, -5, 40}, .target = {0, 0, 0}, .vertical_angle = vertical_angle, .height = 20};
  for (int i = -20; i <= 20; ++i) stroke.point.push_back({0.05 * i, 0.2 * std::sin(0.3 * i)});
  return stroke;
}

SheetCut paraboloid() {
  SheetCut sheet;
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j) {
      const double x = 2 * i, y = 2 * j;
      sheet.point.push_back({x, y, 0.05 * (x * x + y * y)});
      sheet.normal.push_back({-0.1 * x, -0.1 * y, 1});
    }
  return sheet;
}

struct Named {
  std::string name;
  std::unique_ptr<LevelSet> level_set;
};
std::vector<Named> all_shapes() {
  std::vector<Named> all;
  const auto add = [&](const std::string& name, std::unique_ptr<LevelSet> level_set) {
    all.push_back({name, std::move(level_set)});
  };
  add("plane", level_set_of(PlaneCut{{1, 2, 3}, 1.5}));
  add("waves", level_set_of(PlaneCut{{1, 2, 3}, 1.5, {1.5, 6, 3}}));
  add("sphere", level_set_of(SphereCut{{1, 2, -1}, 4}));
  add("box", level_set_of(BoxCut{{1, 0, 2}, {4, 6, 9}, {1, 1, 0}, 0.6}));
  add("cylinder", level_set_of(CylinderCut{{-3, 0, 1}, {4, 3, 2}, 2.5}));
  add("endless cylinder", level_set_of(CylinderCut{{-3, 0, 1}, {4, 3, 2}, 2.5, true}));
  add("stroke", level_set_of(wave_stroke(0)));
  add("stroke in perspective", level_set_of(wave_stroke(0.6)));
  add("loop", level_set_of(circle_stroke(false, 0)));
  StrokeCut scoop = circle_stroke(false, 0.6);
  scoop.from = 35, scoop.to = 44;
  add("scoop", level_set_of(scoop));
  add("surface", level_set_of(testing::sphere_surface(3, 4)));
  add("sheet", level_set_of(paraboloid()));
  return all;
}

TEST(Shapes, SignsInBallsAreNeverContradicted) {
  for (const Named& one : all_shapes()) {
    SCOPED_TRACE(one.name);
    Random random(31, 0);
    int certain = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3d center = random_point(random, 15);
      const double radius = random.uniform(0.1, 4);
      const int side = one.level_set->side_of_ball(center, radius);
      certain += side != 0;
      for (int k = 0; side != 0 && k < 30; ++k) {
        Vec3d off = random_point(random, 1);
        off *= radius * std::min(1.0, k % 2 ? 1 / off.norm() : 1.0) / std::max(1.0, off.norm());
        ASSERT_GT(side * one.level_set->value(center + off), 0) << center.transpose() << " radius " << radius;
      }
    }
    if (one.name != "sheet") {
      EXPECT_GT(certain, 600);
    }
  }
}

TEST(Shapes, GradientsAreTheSlopesOfValues) {
  for (const Named& one : all_shapes()) {
    SCOPED_TRACE(one.name);
    Random random(32, 0);
    int wrong = 0;
    for (int i = 0; i < 500; ++i) {
      const Vec3d x = random_point(random, 8);
      const double step = 1e-5;
      Vec3d slope;
      for (int axis = 0; axis < 3; ++axis)
        slope[axis] = (one.level_set->value(x + step * Vec3d::Unit(axis)) -
                       one.level_set->value(x - step * Vec3d::Unit(axis))) /
                      (2 * step);
      wrong += (slope - one.level_set->gradient(x)).norm() > 2e-3 * (1 + slope.norm());
    }
    EXPECT_LE(wrong, 5); // beside creases
  }
}

TEST(Shapes, BoxesAndCylindersAreDistances) {
  const auto box = level_set_of(BoxCut{{1, 1, 1}, {2, 4, 6}});
  EXPECT_DOUBLE_EQ(box->value({1, 1, 1}), -1);
  EXPECT_DOUBLE_EQ(box->value({4, 1, 1}), 2);
  EXPECT_DOUBLE_EQ(box->value({5, 6, 1}), std::hypot(3, 3));
  const auto turned = level_set_of(BoxCut{{0, 0, 0}, {2, 4, 6}, {0, 0, 2}, std::numbers::pi / 2});
  EXPECT_NEAR(turned->value({2, 0, 0}), 0, 1e-12);
  const auto corer = level_set_of(CylinderCut{{0, 0, -5}, {0, 0, 5}, 2});
  EXPECT_DOUBLE_EQ(corer->value({0, 0, 0}), -2);
  EXPECT_DOUBLE_EQ(corer->value({3, 0, 0}), 1);
  EXPECT_DOUBLE_EQ(corer->value({0, 5, 9}), 5);
  EXPECT_DOUBLE_EQ(level_set_of(CylinderCut{{0, 0, -5}, {0, 0, 5}, 2, true})->value({0, 5, 9}), 3);
}

TEST(Shapes, ALoopIsInsideWhicheverWayItIsDrawn) {
  for (const bool clockwise : {false, true})
    for (const double angle : {0.0, 0.6}) {
      const auto loop = level_set_of(circle_stroke(clockwise, angle));
      EXPECT_LT(loop->value({0, 0, 0}), 0);
      EXPECT_LT(loop->value({1, -2, 10}), 0);
      EXPECT_GT(loop->value({9, 0, 0}), 0);
      EXPECT_GT(loop->value({0, -9, -5}), 0);
    }
  const auto loop = level_set_of(circle_stroke(false, 0)); // radius 5 mm
  for (int i = 0; i < 50; ++i) {
    const double angle = 0.1257 * i;
    EXPECT_NEAR(loop->value(Vec3d(5 * std::cos(angle), 5 * std::sin(angle), i)), 0, 0.01);
  }
}

TEST(Shapes, ASheetGoesThroughItsPoints) {
  const SheetCut sheet = paraboloid();
  const auto level_set = level_set_of(sheet);
  for (std::size_t i = 0; i < sheet.point.size(); ++i) {
    EXPECT_NEAR(level_set->value(sheet.point[i]), 0, 1e-5);
    EXPECT_GT(level_set->gradient(sheet.point[i]).normalized().dot(sheet.normal[i].normalized()), 0.995);
  }
  EXPECT_NEAR(level_set->value({1, 1, 0.1}), 0, 0.02); // between them
}

TEST(Shapes, EveryShapeCutsAndTheHalvesAreSound) {
  TetMesh mesh = tet_grid(10, 10, 10);
  for (Vec3d& x : mesh.position) x -= Vec3d::Constant(5);
  const Boundary boundary = boundary_of(mesh);
  for (const Named& one : all_shapes()) {
    SCOPED_TRACE(one.name);
    Pieces fast = whole_piece(mesh), slow = fast;
    Cutter(mesh, boundary).cut(fast, *one.level_set);
    cut(slow, mesh, boundary, *one.level_set);
    EXPECT_TRUE(same_bits(fast, slow));
    check_pieces(fast, mesh, boundary);
    for (const CutTet& tet : fast.piece[0].cut)
      for (int i = 0; i < 4; ++i)
        for (const int c : facet_corners[i]) {
          if (!tet.face[i].is_section()) continue;
          ASSERT_LT(std::abs(one.level_set->value(fast.position(mesh, tet.corner[c]))), 0.03);
        }
  }
}

TEST(Shapes, RefuseWhatIsNoShape) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refuses = [](const auto& shape, const std::string& what) {
    EXPECT_NE(refusal([&] { level_set_of(shape); }).find(what), std::string::npos) << what;
  };
  refuses(BoxCut{{0, 0, 0}, {1, 0, 1}}, "edge of the box is 0");
  refuses(BoxCut{{0, nan, 0}, {1, 1, 1}}, "not finite");
  refuses(BoxCut{{0, 0, 0}, {1, 1, 1}, {0, 0, 0}, 1}, "axis of the turn");
  refuses(CylinderCut{{1, 1, 1}, {1, 1, 1}, 2}, "one place");
  refuses(CylinderCut{{1, 1, 1}, {1, 1, 2}, -2}, "radius");
  refuses(SheetCut{}, "no points");
  refuses(SheetCut{{{0, 0, 0}}, {}}, "0 normals");
  refuses(SheetCut{{{0, 0, 0}, {0, 0, 0}}, {{0, 0, 1}, {0, 0, 1}}}, "twice");
  refuses(SheetCut{{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, 0, 0}}}, "normal of point 1");
  StrokeCut loop = circle_stroke(false, 0);
  loop.from = 5, loop.to = 4;
  refuses(loop, "scooped from");
  loop = circle_stroke(false, 0);
  loop.point = {{0, 0}, {1, 0}, {0.5, 0}};
  refuses(loop, "no area");
  loop.point = {{0, 0}, {1, 1}, {1, 0}, {0, 1.5}};
  refuses(loop, "crosses itself");
  loop.point = {{0, 0}, {1, nan}, {1, 0}};
  refuses(loop, "finite");
}

} // namespace
} // namespace pith
