#include "raytrace/framing.h"

#include "volume/base/error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

namespace pith {

namespace {

/// The section area that is seen from far away in a direction; facing it by more than 0.85 gains nothing, because a
/// little of the skin should be seen too.
double seen_section(const Scene& scene, const Vec3d& direction) {
  const Vec3d right = scene.options().up.cross(direction);
  const double clearance = 1e-4 * scene.bounds().diagonal();
  double seen = 0;
  for (const Scene::SectionSample& sample : scene.section_samples()) {
    const double area = sample.area.norm(), facing = sample.area.dot(direction);
    if (!(facing > 0) || scene.occluded({sample.position + clearance / area * sample.area, direction})) continue;
    seen += std::min(facing, 0.85 * area) * (1 - 0.1 * sample.area.dot(right) / area);
  }
  return seen;
}

/// From the front, or where most of the sections is seen, and always from a little above.
Vec3d chosen_direction(const Scene& scene) {
  const Vec3d up = scene.options().up;
  const Vec3d aside = std::abs(up.x()) < 0.9 ? Vec3d::UnitX() : Vec3d::UnitZ();
  const Vec3d front = aside.cross(up).normalized(), right = up.cross(front);
  constexpr int turns = 24;
  constexpr double rises[3][2] = {{0.42, 1.0}, {0.72, 0.96}, {1.05, 0.9}}; // elevation in radians, preference
  constexpr double start = 0.4;                                            // radians to the right of the front
  Vec3d best =
      std::cos(rises[0][0]) * (std::cos(start) * front + std::sin(start) * right) + std::sin(rises[0][0]) * up;
  double most = 0;
  for (int turn = 0; turn < turns; ++turn) {
    // 0, 1, −1, 2, −2 ...: near-equals go to the one closest to the front.
    const double angle = start + (turn % 2 ? 1 : -1) * ((turn + 1) / 2) * 2 * std::numbers::pi / turns;
    for (const auto& [rise, preference] : rises) {
      const Vec3d level = std::cos(angle) * front + std::sin(angle) * right;
      const Vec3d direction = std::cos(rise) * level + std::sin(rise) * up;
      const double seen = preference * seen_section(scene, direction);
      if (seen > 1.01 * most) {
        most = seen;
        best = direction;
      }
    }
  }
  return best;
}

} // namespace

View framed_view(const Scene& scene, const FramingOptions& options) {
  if (!(options.aspect > 0) || !(options.margin >= 0 && options.margin < 1) || !(options.vertical_angle < 3) ||
      !options.direction.allFinite())
    throw InvalidInput("camera", "aspect, margin, angle or direction is out of range",
                       "give an aspect above 0, a margin of 0 to 1, an angle below 3 radians");
  const Vec3d direction = (options.direction.norm() > 0 ? options.direction : chosen_direction(scene)).normalized();
  View view;
  view.up = scene.options().up;
  if (view.up.cross(direction).norm() < 1e-3) view.up = direction.unitOrthogonal();
  view.vertical_angle = options.vertical_angle;
  view.target = scene.bounds().center();
  view.eye = view.target + direction;
  const Vec3d right = view.right(), upward = view.upward(), forward = view.forward();
  const double inner = 1 - options.margin;
  const auto& points = scene.points();

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

} // namespace pith
