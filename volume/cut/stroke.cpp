// A stroke as a level set: Takayama, Okabe, Ijiri, Igarashi: Lapped solid textures, 2008, §5.1.1; the spline is that
// of Turk, O'Brien: Shape transformation using variational implicit functions, 1999, with points beside the curve.
//
// Departure: a spline alone may have zeros far from the stroke. It is only allowed to move the signed distance to the
// stroke by a small amount, and only near the stroke, so that the side is right everywhere else. Its kernel is r³,
// not the plane's r² log r: the curve is as smooth, and a square root costs a fifth of a logarithm.
#include "volume/base/error.h"
#include "volume/cut/divider.h"
#include "volume/cut/level_set.h"
#include "volume/field/radial_basis.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace pith {
namespace {

constexpr std::size_t most_nodes = 36;

struct Smooth {
  double value, slope;
};
/// 0 up to `from`, 1 beyond `to`.
Smooth smooth_step(double x, double from, double to) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return {t * t * (3 - 2 * t), 6 * t * (1 - t) / (to - from)};
}

/// A view with its axes computed once.
struct Screen {
  Vec3d eye, right, upward, forward;
  bool orthographic;
  double per_depth; ///< half the picture's height per mm of depth
  double half;      ///< half the picture's height, orthographic
  double nearest;   ///< depths below count as this

  struct Place {
    Vec2d at;
    double half;      ///< mm per screen unit at the depth of the point
    Vec3d half_slope; ///< its gradient
  };
  Place place(const Vec3d& x) const {
    const Vec3d to = x - eye;
    Place result;
    result.half = half;
    result.half_slope = Vec3d::Zero();
    if (!orthographic) {
      const double depth = to.dot(forward);
      result.half = std::max(depth, nearest) * per_depth;
      if (depth > nearest) result.half_slope = per_depth * forward;
    }
    result.at = Vec2d(to.dot(right), to.dot(upward)) / result.half;
    return result;
  }
};

Screen screen_of(const View& view, const std::string& where) {
  const std::string field = where + ".view";
  if (!view.eye.allFinite() || !view.target.allFinite() || !view.up.allFinite() ||
      !std::isfinite(view.vertical_angle) || !std::isfinite(view.height))
    throw InvalidInput(field, "a number is not finite", "give finite numbers");
  const Vec3d sight = view.target - view.eye;
  if (!(sight.norm() > 0)) throw InvalidInput(field, "eye and target are at one place", "move one of them");
  if (!(sight.cross(view.up).norm() > 1e-9 * sight.norm() * view.up.norm()))
    throw InvalidInput(field, "up is parallel to the direction of sight", "give another up");
  if (view.orthographic() && !(view.height > 0))
    throw InvalidInput(field, "the height is " + std::to_string(view.height) + " mm", "give a positive height");
  if (view.vertical_angle >= 3.1)
    throw InvalidInput(field, "the opening angle is " + std::to_string(view.vertical_angle) + " radians",
                       "give an angle below 3.1");
  return {.eye = view.eye,
          .right = view.right(),
          .upward = view.upward(),
          .forward = view.forward(),
          .orthographic = view.orthographic(),
          .per_depth = std::tan(0.5 * view.vertical_angle),
          .half = 0.5 * view.height,
          .nearest = 1e-3 * sight.norm()};
}

class Stroke final : public LevelSet {
public:
  Stroke(const StrokeNodes& nodes, const Screen& screen, const std::string& where)
      : screen_(screen), divider_(nodes, where), spacing_(2 * nodes.length / most_nodes), reach_(spacing_ / 8) {
    fit(nodes);
  }

  double value(const Vec3d& x) const override {
    const Screen::Place place = screen_.place(x);
    return place.half * on_screen(place.at, nullptr);
  }

  // u = to · right / half, so half ∇u = right − u ∇half, and likewise for v.
  Vec3d gradient(const Vec3d& x) const override {
    const Screen::Place place = screen_.place(x);
    Vec2d slope;
    const double value = on_screen(place.at, &slope);
    return value * place.half_slope + slope.x() * (screen_.right - place.at.x() * place.half_slope) +
           slope.y() * (screen_.upward - place.at.y() * place.half_slope);
  }

  /// Farther than the spline's reach from the stroke, the sign is that of the distance on the screen, where the ball
  /// covers a disk.
  int side_of_ball(const Vec3d& center, double radius) const override {
    const Vec2d at = screen_.place(center).at;
    double disk = radius / screen_.half;
    if (!screen_.orthographic) {
      const double nearest = (center - screen_.eye).dot(screen_.forward) - radius;
      if (!(nearest > screen_.nearest)) return 0;
      disk = radius / nearest * (1 / screen_.per_depth + at.norm());
    }
    const double distance = divider_.nearest(at).distance;
    const double reach = (disk + reach_) * (1 + 1e-9) + 1e-9 * std::abs(distance);
    return (distance > reach) - (distance < -reach);
  }

private:
  void fit(const StrokeNodes& nodes) {
    std::vector<Vec3d> center;
    std::vector<double> value;
    const auto add = [&](const Vec2d& at, double expected) {
      const double distance = divider_.nearest(at).distance;
      if (std::abs(distance - expected) > 0.5 * std::abs(expected) + 1e-9 * nodes.length)
        return; // another arm is near
      center.emplace_back(at.x(), at.y(), 0.0);
      value.push_back(expected == 0 ? 0 : distance);
    };
    const auto add_across = [&](const Vec2d& at, const Vec2d& normal, double offset) {
      add(at, 0);
      add(at + offset * normal, offset);
      add(at - offset * normal, -offset);
    };
    const std::size_t count = nodes.node.size();
    for (std::size_t i = 0; i < count; ++i) {
      double gap = spacing_;
      if (i > 0 || nodes.closed) gap = std::min(gap, (nodes.node[i] - nodes.node[(i + count - 1) % count]).norm());
      if (i + 1 < count || nodes.closed) gap = std::min(gap, (nodes.node[i] - nodes.node[(i + 1) % count]).norm());
      add_across(nodes.node[i], divider_.normal(i), std::max(0.5 * gap, 0.1 * spacing_));
    }
    for (const double along : {1.0, 2.0})
      for (const bool end : {false, true}) {
        if (nodes.closed) continue;
        const Vec2d direction = end ? nodes.end_direction : nodes.start_direction;
        const Vec2d across(direction.y(), -direction.x());
        add_across((end ? nodes.node.back() : nodes.node.front()) + along * spacing_ * direction,
                   end ? across : Vec2d(-across), 0.5 * spacing_);
      }
    try {
      spline_ = RadialBasis::fit(center, value, {.kernel = Kernel::triharmonic});
    } catch (const SolverFailure&) {
      spline_.reset(); // the signed distance alone is a right, if less smooth, cut
    }
  }

  double on_screen(const Vec2d& at, Vec2d* slope) const {
    const Divider::Nearest nearest = divider_.nearest(at);
    if (slope) *slope = nearest.gradient;
    const double distance = nearest.distance, side = distance < 0 ? -1 : 1;
    const Smooth beside = smooth_step(side * distance, reach_, 4 * reach_);
    const Smooth beyond = smooth_step(nearest.beyond, spacing_, 2 * spacing_);
    const double near = (1 - beside.value) * (1 - beyond.value);
    if (near == 0 || !spline_) return distance;

    const Vec3d flat(at.x(), at.y(), 0);
    const double free_shift = spline_->value(flat) - distance;
    const double shift = std::clamp(free_shift, -reach_, reach_);
    if (slope) {
      if (shift == free_shift) *slope += near * (spline_->gradient(flat).head<2>() - nearest.gradient);
      *slope -= shift * (1 - beyond.value) * beside.slope * side * nearest.gradient;
      *slope -= shift * (1 - beside.value) * beyond.slope * nearest.outward;
    }
    return distance + near * shift;
  }

  Screen screen_;
  Divider divider_;
  double spacing_; ///< largest distance of nodes, screen units
  double reach_;   ///< how far the spline may move the zero set
  std::optional<RadialBasis> spline_;
};

} // namespace

std::unique_ptr<LevelSet> level_set_of(const StrokeCut& stroke, const std::string& where) {
  const Screen screen = screen_of(stroke.view, where);
  if (stroke.closed) {
    if (!(stroke.from < stroke.to))
      throw InvalidInput(where,
                         "it is scooped from " + std::to_string(stroke.from) + " to " + std::to_string(stroke.to) +
                             " mm from the eye",
                         "give a \"from\" that is less than \"to\"");
    std::vector<std::unique_ptr<LevelSet>> part;
    part.push_back(
        std::make_unique<Stroke>(loop_nodes(stroke.point, most_nodes, where + ".point"), screen, where + ".point"));
    const double eye = screen.forward.dot(screen.eye);
    if (std::isfinite(stroke.from))
      part.push_back(level_set_of(PlaneCut{-screen.forward, -(eye + stroke.from)}, where));
    if (std::isfinite(stroke.to)) part.push_back(level_set_of(PlaneCut{screen.forward, eye + stroke.to}, where));
    return part.size() == 1 ? std::move(part[0]) : shared_by(std::move(part));
  }
  const StrokeNodes nodes = stroke_nodes(stroke.point, most_nodes, where + ".point");
  if (!nodes.straight) return std::make_unique<Stroke>(nodes, screen, where + ".point");

  // Right of the direction of drawing is positive: n · (u, v) = c on the screen is n · (to · right, to · upward) =
  // c · half in space, a plane (through the eye, in perspective).
  const Vec2d along = nodes.node.back() - nodes.node.front();
  const Vec2d n = Vec2d(along.y(), -along.x()).normalized();
  const double c = n.dot(nodes.node.front());
  Vec3d normal = n.x() * screen.right + n.y() * screen.upward;
  double offset = normal.dot(screen.eye);
  if (screen.orthographic) {
    offset += c * screen.half;
  } else {
    normal -= c * screen.per_depth * screen.forward;
    offset = normal.dot(screen.eye);
  }
  return level_set_of(PlaneCut{normal, offset}, where);
}

} // namespace pith
