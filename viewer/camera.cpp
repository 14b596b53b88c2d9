#include "viewer/camera.h"

#include <nlohmann/json.hpp>
#include <numbers>

namespace pith {

Camera Camera::framing(const Box& bounds, const Vec3d& direction, const Vec3d& up, double aspect) {
  View view;
  const double radius = std::max(0.5 * bounds.diagonal(), 1e-9);
  const double half = 0.5 * view.vertical_angle;
  const double narrow = std::atan(std::tan(half) * std::min(1.0, aspect));
  view.target = bounds.empty() ? Vec3d::Zero() : bounds.center();
  view.eye = view.target + direction.normalized() * (1.02 * radius / std::sin(narrow));
  view.up = up;
  view.height = 2.1 * radius / std::min(1.0, aspect);
  return Camera(view);
}

double mm_per_unit(const View& view, const Vec3d& x) {
  if (view.orthographic()) return 0.5 * view.height;
  return (x - view.eye).dot(view.forward()) * std::tan(0.5 * view.vertical_angle);
}

void Camera::orbit(double right, double up) {
  const Vec3d axis = view_.up.normalized();
  Vec3d to_eye = Eigen::AngleAxisd(right, axis) * (view_.eye - view_.target);
  const double now = std::acos(std::clamp(to_eye.normalized().dot(axis), -1.0, 1.0)); // from the pole
  const double next = std::clamp(now - up, 0.02, std::numbers::pi - 0.02);
  to_eye = Eigen::AngleAxisd(next - now, axis.cross(to_eye).normalized()) * to_eye;
  view_.eye = view_.target + to_eye;
}

void Camera::pan(const Vec2d& from, const Vec2d& to) {
  const Vec2d by = mm_per_unit(view_, view_.target) * (from - to);
  const Vec3d shift = by.x() * view_.right() + by.y() * view_.upward();
  view_.eye += shift;
  view_.target += shift;
}

void Camera::zoom(double factor, const Vec2d& at) {
  const double half = mm_per_unit(view_, view_.target);
  const Vec3d toward = half * (1 - 1 / factor) * (at.x() * view_.right() + at.y() * view_.upward());
  view_.target += toward;
  view_.eye = view_.target + (view_.eye + toward - view_.target) / factor;
  view_.height /= factor;
}

void Camera::center_on(const Vec3d& target) {
  view_.eye += target - view_.target;
  view_.target = target;
}

void Camera::set_orthographic(bool orthographic) {
  if (orthographic == view_.orthographic()) return;
  const double usual = View().vertical_angle;
  if (orthographic) {
    view_.height = 2 * mm_per_unit(view_, view_.target);
    view_.vertical_angle = 0;
  } else {
    view_.eye = view_.target - view_.forward() * (0.5 * view_.height / std::tan(0.5 * usual));
    view_.vertical_angle = usual;
  }
}

std::string Camera::text() const {
  const auto list = [](const Vec3d& v) { return nlohmann::ordered_json{v.x(), v.y(), v.z()}; };
  nlohmann::ordered_json json = {{"eye", list(view_.eye)},
                                 {"target", list(view_.target)},
                                 {"up", list(view_.up)},
                                 {"vertical_angle", view_.vertical_angle}};
  if (view_.orthographic()) json["height"] = view_.height;
  return json.dump();
}

} // namespace pith
