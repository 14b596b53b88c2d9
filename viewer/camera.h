#pragma once
// Where the window looks from: a view that mouse and keys move.
#include "volume/base/view.h"

#include <string>

namespace pith {

/// Millimetres that one screen unit spans at a world point's distance from the eye.
double mm_per_unit(const View& view, const Vec3d& x);

/// Turns about its target. All moves keep the up direction's sense, so that the picture never rolls over.
class Camera {
public:
  Camera() = default;
  /// Looks at a box from `direction` (towards the eye), so that all of it shows.
  static Camera framing(const Box& bounds, const Vec3d& direction, const Vec3d& up, double aspect);
  explicit Camera(const View& view) : view_(view) {}

  const View& view() const { return view_; }

  void orbit(double right, double up);          ///< radians; the eye goes that way around the target
  void pan(const Vec2d& from, const Vec2d& to); ///< screen coordinates: what was under `from` comes under `to`
  void zoom(double factor, const Vec2d& at);    ///< above 1: nearer; what is under `at` stays there
  void center_on(const Vec3d& target);          ///< world; the direction of sight stays
  void set_orthographic(bool orthographic);     ///< what is at the target keeps its size

  /// JSON, as parse_view reads it and recipes write it.
  std::string text() const;

private:
  View view_;
};

} // namespace pith
