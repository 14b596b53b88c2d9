#pragma once
// Where somebody looks from: shared by strokes (a stroke is drawn in a view), cameras and the window.
#include "volume/base/types.h"

#include <cmath>

namespace pith {

/// A pinhole or orthographic view. Screen coordinates (u, v): the vertical extent of the picture is v ∈ [−1, 1], upwards;
/// u goes right with the same unit.
struct View {
  Vec3d eye{0, 0, 100};
  Vec3d target{0, 0, 0};
  Vec3d up{0, 1, 0};
  double vertical_angle = 0.6; ///< full opening angle, radians; 0: orthographic
  double height = 100;         ///< mm seen from bottom to top when orthographic

  Vec3d forward() const { return (target - eye).normalized(); }
  Vec3d right() const { return forward().cross(up).normalized(); }
  Vec3d upward() const { return right().cross(forward()); }
  bool orthographic() const { return vertical_angle <= 0; }

  /// Screen position of a rest or world point. Precondition when perspective: the point lies in front of the eye.
  Vec2d project(const Vec3d& x) const {
    const Vec3d to = x - eye;
    const double half = orthographic() ? 0.5 * height : to.dot(forward()) * std::tan(0.5 * vertical_angle);
    return {to.dot(right()) / half, to.dot(upward()) / half};
  }

  struct Ray {
    Vec3d origin, direction; ///< direction has unit length
  };
  Ray ray(double u, double v) const {
    if (orthographic()) return {eye + 0.5 * height * (u * right() + v * upward()), forward()};
    const double t = std::tan(0.5 * vertical_angle);
    return {eye, (forward() + t * (u * right() + v * upward())).normalized()};
  }
};

} // namespace pith
