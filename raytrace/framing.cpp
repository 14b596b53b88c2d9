#include "raytrace/framing.h"

#include "volume/base/error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pith {

namespace {

/// A thousand places of the sections against so many points of the outline: scoring needs no more.
constexpr std::size_t scoring_points = 6000;

/// The closest view along `direction` in which all points lie inside the border.
View view_around(const std::vector<Vec3d>& points, const Scene& scene, const Vec3d& direction,
                 const FramingOptions& options) {
  View view;
  view.up = scene.options().up;
  if (view.up.cross(direction).norm() < 1e-3) view.up = direction.unitOrthogonal();
  view.vertical_angle = options.vertical_angle;
  view.target = scene.bounds().center();
  view.eye = view.target + direction;
  const Vec3d right = view.right(), upward = view.upward(), forward = view.forward();
  const double inner = 1 - options.margin;

  if (view.orthographic()) {
    double left = 1e300, far_right = -1e300, low = 1e300, high = -1e300;
    for (const Vec3d& p : points) {
      const double x = p.dot(right), y = p.dot(upward);
      left = std::min(left, x), far_right = std::max(far_right, x);
      low = std::min(low, y), high = std::max(high, y);
    }
    const double radius = 0.5 * scene.bounds().diagonal();
    view.target += (0.5 * (left + far_right) - view.target.dot(right)) * right +
                   (0.5 * (low + high) - view.target.dot(upward)) * upward;
    view.eye = view.target + 4 * radius * direction;
    view.height = std::max({(high - low) / inner, (far_right - left) / (inner * options.aspect), 1e-6});
    return view;
  }

  // Each side of the picture is a plane through the eye. The apex of two opposite planes pushed out to touch the
  // points is exact per axis; the eye takes the larger distance of the two axes.
  const double tan_v = inner * std::tan(0.5 * options.vertical_angle), tan_u = tan_v * options.aspect;
  const auto apex = [&](const Vec3d& axis, double tangent, double& side, double& depth) {
    // A point is inside when |(p − e)·axis| ≤ tangent · (p − e)·forward.
    double plus = -1e300, minus = -1e300;
    for (const Vec3d& p : points) {
      const double s = p.dot(axis), d = tangent * p.dot(forward);
      plus = std::max(plus, s - d);
      minus = std::max(minus, -s - d);
    }
    side = 0.5 * (plus - minus);
    depth = -0.5 * (plus + minus) / tangent;
  };
  double u, v, depth_u, depth_v;
  apex(right, tan_u, u, depth_u);
  apex(upward, tan_v, v, depth_v);
  const double depth = std::min(depth_u, depth_v);
  view.eye = u * right + v * upward + depth * forward;
  const double reach = std::max(1e-6, scene.bounds().center().dot(forward) - depth);
  view.target = view.eye + reach * forward;
  return view;
}

/// What the eye gets to see of the sections: the sum of seen areas, turned towards the eye, mm². Where `in_picture`
/// is set, each counts more the larger it is in the picture (by its length, not its area: a section should rather
/// face the eye than stand close to it), and facing the eye by more than 0.85 gains nothing, because a little of the
/// skin should be seen too.
double seen_sections(const Scene& scene, const View& view, bool in_picture) {
  const double clearance = 1e-4 * scene.bounds().diagonal();
  const double half = std::tan(0.5 * view.vertical_angle);
  double seen = 0;
  for (const Scene::SectionSample& sample : scene.section_samples()) {
    const double area = sample.area.norm();
    if (!(area > 0)) continue;
    const Vec3d start = sample.position + clearance / area * sample.area;
    const Vec3d to_eye = view.orthographic() ? Vec3d(-view.forward()) : Vec3d((view.eye - start).normalized());
    const double facing = sample.area.dot(to_eye);
    if (!(facing > 0)) continue;
    const double distance = (view.eye - start).norm();
    const double end = view.orthographic() ? std::numeric_limits<double>::infinity() : distance;
    if (scene.occluded({start, to_eye, end})) continue;
    const double height = view.orthographic() ? view.height : 2 * half * distance; // of the picture, there
    seen += in_picture ? std::min(facing, 0.85 * area) / height : facing;
  }
  return seen;
}

/// From the front, or where the sections are seen best, and always from a little above; without a ground also from
/// below. Directions on a grid are tried first, then ever closer ones around the best.
Vec3d chosen_direction(const Scene& scene, const FramingOptions& options) {
  const Vec3d up = scene.options().up;
  const Vec3d aside = std::abs(up.x()) < 0.9 ? Vec3d::UnitX() : Vec3d::UnitZ();
  const Vec3d front = aside.cross(up).normalized(), right = up.cross(front);
  const auto direction_at = [&](double turn, double rise) {
    return Vec3d(std::cos(rise) * (std::cos(turn) * front + std::sin(turn) * right) + std::sin(rise) * up);
  };
  constexpr double start = 0.4, level = 0.42; // radians to the right of the front, above the horizon
  struct Choice {
    double turn, rise, score;
  };
  Choice best{start, level, 0};
  if (!(scene.section_area() > 0)) return direction_at(best.turn, best.rise);

  std::vector<Vec3d> points;
  const std::size_t stride = 1 + scene.points().size() / scoring_points;
  for (std::size_t i = 0; i < scene.points().size(); i += stride) points.push_back(scene.points()[i]);
  const bool from_below = !scene.options().ground.on;
  const auto try_one = [&](double turn, double rise, double advantage) {
    const double away = std::abs(rise - level); // steep and grazing views, and views of the back, have to be better
    const double preference = 1 - 0.25 * away * away - (rise < 0 ? 0.1 : 0) - 0.02 * (1 - std::cos(turn - start));
    const View view = view_around(points, scene, direction_at(turn, rise), options);
    const double score = preference * seen_sections(scene, view, true);
    if (score > advantage * best.score) best = {turn, rise, score};
  };
  constexpr int turns = 24;
  constexpr double step = 2 * std::numbers::pi / turns;
  for (int turn = 0; turn < turns; ++turn) {
    // 0, 1, −1, 2, −2 ...: near-equals go to the one closest to the front.
    const double angle = start + (turn % 2 ? 1 : -1) * ((turn + 1) / 2) * step;
    for (const double rise : {level, 0.7, 0.2, 1.05}) {
      try_one(angle, rise, 1.01);
      if (from_below) try_one(angle, -rise, 1.01);
    }
  }
  for (const double closer : {0.5, 0.25}) {
    const Choice middle = best;
    for (const double side : {0.0, 1.0, -1.0})
      for (const double above : {0.0, 1.0, -1.0}) {
        const double rise = middle.rise + above * closer * step;
        if ((side == 0 && above == 0) || std::abs(rise) < 0.15 || std::abs(rise) > 1.2) continue;
        try_one(middle.turn + side * closer * step, rise, 1.01);
      }
  }
  return direction_at(best.turn, best.rise);
}

} // namespace

double section_share(const Scene& scene, const View& view) {
  return scene.section_area() > 0 ? seen_sections(scene, view, false) / scene.section_area() : 1;
}

View framed_view(const Scene& scene, const FramingOptions& options) {
  if (!(options.aspect > 0) || !(options.margin >= 0 && options.margin < 1) || !(options.vertical_angle < 3) ||
      !options.direction.allFinite())
    throw InvalidInput("camera", "aspect, margin, angle or direction is out of range",
                       "give an aspect above 0, a margin of 0 to 1, an angle below 3 radians");
  const Vec3d direction =
      options.direction.norm() > 0 ? options.direction.normalized() : chosen_direction(scene, options).normalized();
  return view_around(scene.points(), scene, direction, options);
}

} // namespace pith
