// Strokes: the side of every point, the smoothness of the section, views, and what is refused.
#include "tests/cut/piece_checks.h"
#include "tests/support/tet_grid.h"
#include "volume/base/random.h"
#include "volume/cut/divider.h"

namespace pith {
namespace {

/// A view onto the x-y plane from +z in which screen units are millimetres / 10.
View front_view() {
  return {.eye = {0, 0, 100}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vertical_angle = 0, .height = 20};
}

/// The side of a point by an independent way: a polygon made of the stroke and a far way round on its left; the
/// crossing rule tells whether the point is inside, that is on the left.
bool left_of(const std::vector<Vec2d>& stroke, const Vec2d& start_direction, const Vec2d& end_direction,
             const Vec2d& x) {
  constexpr double far = 1e3;
  std::vector<Vec2d> polygon = {stroke.front() + far * start_direction};
  polygon.insert(polygon.end(), stroke.begin(), stroke.end());
  polygon.push_back(stroke.back() + far * end_direction);
  // Counter-clockwise from the end's direction to the start's, on a wide circle.
  double from = std::atan2(end_direction.y(), end_direction.x()),
         to = std::atan2(start_direction.y(), start_direction.x());
  while (to <= from) to += 2 * M_PI;
  for (int i = 1; i < 64; ++i) {
    const double angle = from + (to - from) * i / 64;
    polygon.push_back(2 * far * Vec2d(std::cos(angle), std::sin(angle)));
  }
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > x.y()) == (b.y() > x.y())) continue;
    inside ^= x.x() < a.x() + (x.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
  }
  return inside;
}

double distance_to(const std::vector<Vec2d>& stroke, const Vec2d& x) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < stroke.size(); ++i) {
    const Vec2d along = stroke[i] - stroke[i - 1];
    const double t = std::clamp((x - stroke[i - 1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    smallest = std::min(smallest, (x - stroke[i - 1] - t * along).norm());
  }
  return smallest;
}

/// A hand-drawn line from left to right: some waves and a little jitter.
std::vector<Vec2d> wavy_stroke(std::uint64_t seed, int points = 500) {
  Random random(21, seed);
  const double height = random.uniform(-0.2, 0.2), first = random.uniform(0.05, 0.25),
               second = random.uniform(0, 0.08), phase = random.uniform(0, 6.28);
  std::vector<Vec2d> stroke;
  for (int i = 0; i < points; ++i) {
    const double s = i / (points - 1.0), u = -1.2 + 2.4 * s;
    stroke.emplace_back(u + random.uniform(-5e-4, 5e-4), height + first * std::sin(4 * u + phase) +
                                                             second * std::sin(9 * u) + random.uniform(-5e-4, 5e-4));
  }
  return stroke;
}

TEST(Stroke, TheSignIsTheSideOfTheStroke) {
  for (int seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::vector<Vec2d> stroke = wavy_stroke(seed);
    const auto level_set = level_set_of(StrokeCut{stroke, front_view()});
    EXPECT_FALSE(level_set->linear());
    const StrokeNodes nodes = stroke_nodes(stroke, 36, "stroke");
    const double near = nodes.length / 144 + nodes.length / 250;
    Random random(22, seed);
    std::size_t wrong = 0, checked = 0;
    for (int i = 0; i < 5000; ++i) {
      const double reach = i % 2 ? 1.2 : 8;
      const Vec2d x(random.uniform(-reach, reach), random.uniform(-reach, reach));
      if (distance_to(stroke, x) < near || std::abs(x.x()) > 1.15 /* beside a continuation */) continue;
      ++checked;
      const bool left = left_of(stroke, nodes.start_direction, nodes.end_direction, x);
      wrong += left != (level_set->value({10 * x.x(), 10 * x.y(), random.uniform(-50, 50)}) < 0);
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(checked, 500u);
  }
}

TEST(Stroke, TheSignIsRightBesideSharpCornersAndNarrowBays) {
  // Where a spline swings out: zigzags, a hairpin whose arms almost touch, a step.
  std::vector<std::vector<Vec2d>> strokes = {
      {{-1.2, 0},
       {-0.6, 0.7},
       {-0.5, -0.7},
       {-0.3, 0.7},
       {-0.1, -0.7},
       {0.2, 0.7},
       {0.3, -0.7},
       {0.6, 0.7},
       {1.2, 0}},
      {{-1.2, 0}, {0, 0}, {0.02, 0.9}, {0.05, 0.9}, {0.07, 0}, {1.2, 0}},
      {{-1.2, -0.3}, {0, -0.3}, {0, 0.3}, {1.2, 0.3}},
      {{-1.2, 0}, {0.1, 0}, {0.1, 0.5}, {-0.5, 0.5}, {-0.5, 0.54}, {0.14, 0.54}, {0.14, 0}, {1.2, 0}}};
  for (std::size_t k = 0; k < strokes.size(); ++k) {
    SCOPED_TRACE("stroke " + std::to_string(k));
    const std::vector<Vec2d>& stroke = strokes[k];
    const auto level_set = level_set_of(StrokeCut{stroke, front_view()});
    const StrokeNodes nodes = stroke_nodes(stroke, 36, "stroke");
    Random random(26, k);
    std::size_t wrong = 0, checked = 0;
    for (int i = 0; i < 50'000; ++i) {
      const Vec2d x(random.uniform(-1.15, 1.15), random.uniform(-0.9, 1.1));
      if (distance_to(stroke, x) < 1.001 * nodes.length / 144) continue;
      ++checked;
      const bool left = left_of(stroke, nodes.start_direction, nodes.end_direction, x);
      wrong += left != (level_set->value({10 * x.x(), 10 * x.y(), 1}) < 0);
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(checked, 25'000u);
  }
}

TEST(Stroke, FollowsTheLineThatWasDrawn) {
  for (int seed = 0; seed < 10; ++seed) {
    const std::vector<Vec2d> stroke = wavy_stroke(seed);
    const auto level_set = level_set_of(StrokeCut{stroke, front_view()});
    for (const Vec2d& p : stroke) EXPECT_LT(std::abs(level_set->value({10 * p.x(), 10 * p.y(), 3})), 10 * 0.01);
  }
}

TEST(Stroke, ContinuationsGoOnStraight) {
  std::vector<Vec2d> arc;
  for (int i = 0; i <= 100; ++i) arc.emplace_back(std::sin(0.01 * i - 0.5), std::cos(0.01 * i - 0.5) - 1);
  const StrokeNodes nodes = stroke_nodes(arc, 36, "stroke");
  const auto level_set = level_set_of(StrokeCut{arc, front_view()});
  for (const double along : {0.01, 0.1, 0.5, 3.0, 50.0})
    for (const bool end : {false, true}) {
      const Vec2d d = end ? nodes.end_direction : nodes.start_direction,
                  n(end ? d.y() : -d.y(), end ? -d.x() : d.x());
      const Vec2d p = (end ? arc.back() : arc.front()) + along * d;
      EXPECT_LT(level_set->value({10 * (p - 0.02 * n).x(), 10 * (p - 0.02 * n).y(), 0}), 0);
      EXPECT_GT(level_set->value({10 * (p + 0.02 * n).x(), 10 * (p + 0.02 * n).y(), 0}), 0);
    }
}

TEST(Stroke, AStraightStrokeIsAPlane) {
  const std::vector<Vec2d> line = {{-0.8, -0.3}, {-0.1, 0.05}, {0.6, 0.4}};
  const auto flat = level_set_of(StrokeCut{line, front_view()});
  EXPECT_TRUE(flat->linear());
  const Vec2d along = (line.back() - line.front()).normalized();
  for (double z : {-30.0, 0.0, 40.0}) {
    EXPECT_NEAR(flat->value({-1, 0.5, z}), 0, 1e-12);
    EXPECT_NEAR(flat->value({-1 + along.y(), 0.5 - along.x(), z}), 1, 1e-12); // a millimetre to the right
  }
  View view{.eye = {30, 40, 50}, .target = {1, 2, 3}, .up = {0, 0, 1}, .vertical_angle = 0.7};
  const auto through_eye = level_set_of(StrokeCut{line, view});
  EXPECT_TRUE(through_eye->linear());
  EXPECT_NEAR(through_eye->value(view.eye), 0, 1e-10);
  for (double s = 0; s <= 1; s += 0.25) {
    const Vec2d p = line.front() + s * (line.back() - line.front());
    const View::Ray ray = view.ray(p.x(), p.y());
    EXPECT_NEAR(through_eye->value(ray.origin + 60 * ray.direction), 0, 1e-10);
    const View::Ray right = view.ray(p.x() + 0.01, p.y() - 0.02);
    EXPECT_GT(through_eye->value(right.origin + 60 * right.direction), 0);
  }
}

TEST(Stroke, ThroughAPerspectiveViewTheSectionContainsTheSightLines) {
  View view{.eye = {5, -60, 40}, .target = {0, 0, 0}, .up = {0, 0, 1}, .vertical_angle = 0.6};
  const std::vector<Vec2d> stroke = wavy_stroke(4);
  const auto level_set = level_set_of(StrokeCut{stroke, view});
  const StrokeNodes nodes = stroke_nodes(stroke, 36, "stroke");
  Random random(23, 1);
  std::size_t wrong = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec2d at(random.uniform(-1.1, 1.1), random.uniform(-1.1, 1.1));
    if (distance_to(stroke, at) < nodes.length / 80) continue;
    const View::Ray ray = view.ray(at.x(), at.y());
    const bool left = left_of(stroke, nodes.start_direction, nodes.end_direction, at);
    wrong += left != (level_set->value(ray.origin + random.uniform(1, 200) * ray.direction) < 0);
  }
  EXPECT_EQ(wrong, 0u);
  // Behind the eye: finite, and continuous across the eye's plane.
  for (int i = 0; i < 1000; ++i) {
    const Vec3d beside = view.eye + random.uniform(-20, 20) * view.right() + random.uniform(-20, 20) * view.upward();
    const double before = level_set->value(beside + 1e-7 * view.forward()),
                 behind = level_set->value(beside - 1e-7 * view.forward());
    EXPECT_TRUE(std::isfinite(level_set->value(beside - 500 * view.forward())));
    EXPECT_TRUE(level_set->gradient(beside - 5 * view.forward()).allFinite());
    EXPECT_NEAR(before, behind, 1e-3);
  }
}

TEST(Stroke, GradientAgreesWithDifferences) {
  View view{.eye = {5, -60, 40}, .target = {0, 0, 0}, .up = {0, 0, 1}, .vertical_angle = 0.6};
  const std::vector<Vec2d> stroke = wavy_stroke(7);
  for (const View& v : {view, front_view()}) {
    const auto level_set = level_set_of(StrokeCut{stroke, v});
    Random random(24, 1);
    int checked = 0, off = 0;
    for (int i = 0; i < 3000; ++i) {
      // Near the stroke and near its continuations, where all terms matter.
      Vec2d at =
          stroke[random.below(stroke.size())] + Vec2d(random.uniform(-0.15, 0.15), random.uniform(-0.15, 0.15));
      if (i % 4 == 0) at = Vec2d(random.uniform(1.1, 1.6), random.uniform(-0.6, 0.6));
      const View::Ray ray = v.ray(at.x(), at.y());
      const Vec3d x = ray.origin + 70 * ray.direction, gradient = level_set->gradient(x);
      Vec3d difference;
      constexpr double step = 1e-4;
      for (int axis = 0; axis < 3; ++axis)
        difference[axis] =
            (level_set->value(x + step * Vec3d::Unit(axis)) - level_set->value(x - step * Vec3d::Unit(axis))) /
            (2 * step);
      ++checked;
      off += (gradient - difference).norm() > 1e-3 * (1 + gradient.norm());
    }
    EXPECT_LT(off, checked / 100); // only across the distance's creases
  }
}

TEST(Stroke, ValuesAreThoseOfSinglePoints) {
  const auto level_set = level_set_of(StrokeCut{wavy_stroke(3), front_view()});
  Random random(25, 1);
  std::vector<Vec3d> points(10'000);
  for (Vec3d& p : points) p = {random.uniform(-12, 12), random.uniform(-6, 6), random.uniform(-10, 10)};
  std::vector<double> values(points.size());
  level_set->values(points, values);
  for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(values[i], level_set->value(points[i]));
}

TEST(Stroke, ContinuationsThatMeetCloseTheCut) {
  // A U whose ends lean towards each other meet above it: inside on the left, all else on the right.
  std::vector<Vec2d> u;
  for (int i = 0; i <= 200; ++i) {
    const double angle = M_PI * (0.9 + 1.2 * i / 200);
    u.emplace_back(0.5 * std::cos(angle), 0.5 * std::sin(angle));
  }
  std::vector<Vec2d> stroke = {{-0.3, 0.6}};
  stroke.insert(stroke.end(), u.begin(), u.end());
  stroke.emplace_back(0.3, 0.6);
  const auto level_set = level_set_of(StrokeCut{stroke, front_view()});
  EXPECT_LT(level_set->value({0, 0, 0}), 0);
  EXPECT_LT(level_set->value({0, 6, 0}), 0);
  for (const Vec2d& x :
       {Vec2d(0, -8), Vec2d(8, 0), Vec2d(-8, 0), Vec2d(0, 60), Vec2d(30, 60), Vec2d(-30, 60), Vec2d(5, 30)})
    EXPECT_GT(level_set->value({x.x(), x.y(), 0}), 0) << x.transpose();
}

TEST(Stroke, CutsABallAndTheSectionIsOnItsZeroSet) {
  const TetMesh mesh = tet_ball(16, 10);
  const Boundary boundary = boundary_of(mesh);
  for (int seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Pieces pieces = whole_piece(mesh);
    for (int c = 0; c < 3; ++c) {
      std::vector<Vec2d> stroke = wavy_stroke(100 + 3 * seed + c);
      View view = front_view();
      if (c == 1) view = {.eye = {60, 10, 5}, .target = {0, 0, 0}, .up = {0, 0, 1}, .vertical_angle = 0.4};
      if (c == 2)
        for (Vec2d& p : stroke) p = Vec2d(-p.y(), p.x());
      const auto level_set = level_set_of(StrokeCut{stroke, view});
      cut(pieces, mesh, boundary, *level_set);
      check_sections_match(pieces, CutId(c));
      std::size_t exact = 0, vertices = 0;
      for (std::size_t i = 0; i < pieces.added.size(); ++i) {
        if (pieces.added[i].cut != CutId(c)) continue;
        ++vertices;
        exact += std::abs(level_set->value(pieces.added_position[i])) < 1e-5;
      }
      EXPECT_GT(exact, vertices * 97 / 100);
    }
    check_pieces(pieces, mesh, boundary);
    EXPECT_GE(pieces.piece.size(), 6u);
    if (HasFailure()) return;
  }
}

TEST(Stroke, RefusesWhatDividesNothing) {
  const auto message = [](std::vector<Vec2d> points, View view = front_view()) {
    return refusal([&] { level_set_of(StrokeCut{std::move(points), view}, "cuts[0].stroke"); });
  };
  std::vector<Vec2d> loop, spiral;
  for (int i = 0; i <= 100; ++i) {
    const double s = i / 100.0;
    loop.emplace_back(std::sin(7 * s), std::cos(7 * s) + s * 0.3);                 // once round and over itself
    spiral.emplace_back((0.1 + s) * std::cos(9 * s), (0.1 + s) * std::sin(9 * s)); // the inner end cannot get out
  }
  const std::vector<std::pair<std::string, std::string>> cases = {
      {message({}), "one place"},
      {message({{0.1, 0.2}}), "one place"},
      {message({{0.1, 0.2}, {0.1, 0.2}}), "one place"},
      {message({{0, 0}, {NAN, 0}}), "point 1 is not finite"},
      {message({{-1, 0}, {1, 0}, {1, 1}, {0, 1}, {0, -1}}), "crosses"},
      {message(loop), "crosses"},
      {message(spiral), "crosses it"},
      {message({{0, 0}, {1, 0}, {0.5, 1e-12}}), "turns back"},
      {message({{0, 0}, {1, 0}}, {.eye = {0, 0, 0}, .target = {0, 0, 0}}), "eye and target"},
      {message({{0, 0}, {1, 0}}, {.eye = {0, 5, 0}, .target = {0, 0, 0}, .up = {0, 1, 0}}), "up is parallel"},
      {message({{0, 0}, {1, 0}}, {.vertical_angle = 0, .height = 0}), "height"},
      {message({{0, 0}, {1, 0}}, {.vertical_angle = 4}), "angle"},
      {message({{0, 0}, {1, 0}}, {.eye = {NAN, 0, 0}}), "not finite"}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_EQ(cases[i].first.rfind("cuts[0].stroke", 0), 0u) << i << " " << cases[i].first;
    EXPECT_NE(cases[i].first.find(cases[i].second), std::string::npos) << i << " " << cases[i].first;
  }
}

} // namespace
} // namespace pith
