#include "raytrace/light.h"

#include "volume/base/error.h"

#include <Eigen/Geometry>
#include <cmath>
#include <string>

namespace pith {

namespace {
void require_light(const Vec3d& color, const std::string& where) {
  if (!color.allFinite() || color.minCoeff() < 0)
    throw InvalidInput(where, "a radiance is negative or not finite", "give three numbers of 0 or more");
}
} // namespace

void validate(const Lights& lights) {
  const Environment& e = lights.environment;
  require_light(e.zenith, "environment.zenith");
  require_light(e.horizon, "environment.horizon");
  require_light(e.nadir, "environment.nadir");
  if (!std::isfinite(e.scale) || e.scale < 0)
    throw InvalidInput("environment.scale", "it is " + std::to_string(e.scale), "give a number of 0 or more");
  if (!std::isfinite(e.turn)) throw InvalidInput("environment.turn", "it is not finite", "give radians");
  const Image& image = e.image;
  if (!image.pixel.empty()) {
    if (image.channels < 3 || image.width < 1 || image.height < 1 ||
        image.pixel.size() != std::size_t(image.width) * image.height * image.channels)
      throw InvalidInput("environment.image",
                         "it is " + std::to_string(image.width) + " × " + std::to_string(image.height) + " with " +
                             std::to_string(image.channels) + " channels",
                         "give a latitude-longitude picture with red, green and blue");
    for (const float value : image.pixel)
      if (!std::isfinite(value))
        throw InvalidInput("environment.image", "it holds values that are not finite", "mend the picture");
  }
  for (std::size_t i = 0; i < lights.area.size(); ++i) {
    const AreaLight& light = lights.area[i];
    const std::string where = "area light " + std::to_string(i);
    require_light(light.radiance, where);
    if (!light.center.allFinite() || !light.edge_u.allFinite() || !light.edge_v.allFinite())
      throw InvalidInput(where, "its place is not finite", "give numbers in mm");
    const double u = light.edge_u.norm(), v = light.edge_v.norm();
    if (!(u > 0) || !(v > 0)) throw InvalidInput(where, "an edge has no length", "give two edges in mm");
    if (std::abs(light.edge_u.dot(light.edge_v)) > 1e-4 * u * v)
      throw InvalidInput(where, "its edges are not at right angles", "give the edges of a rectangle");
  }
}

Lights environment_lights(Image latitude_longitude, double scale, double turn) {
  Lights lights;
  lights.environment.image = std::move(latitude_longitude);
  lights.environment.scale = scale;
  lights.environment.turn = turn;
  return lights;
}

namespace {
/// A rectangle `distance` radii away in `direction` from the subject, facing it.
AreaLight soft_box(const Vec3d& center, const Vec3d& direction, const Vec3d& up, double distance, double width,
                   double height, const Vec3d& radiance) {
  const Vec3d towards = direction.normalized();
  Vec3d aside = up.cross(towards);
  if (aside.norm() < 1e-6) aside = towards.unitOrthogonal();
  aside.normalize();
  AreaLight light;
  light.center = center + distance * towards;
  light.edge_u = -width * aside; // edge_u × edge_v points back to the subject
  light.edge_v = height * towards.cross(aside);
  light.radiance = radiance;
  return light;
}
} // namespace

Lights default_lights(const View& view, const Vec3d& center, double radius, const Vec3d& up_direction) {
  const Vec3d up = up_direction.normalized();
  // Towards the eye and to the right of it, both level.
  Vec3d near = -view.forward();
  near -= near.dot(up) * up;
  if (near.norm() < 1e-3) near = view.upward() - view.upward().dot(up) * up; // seen from above
  near.normalize();
  const Vec3d right = up.cross(near).normalized();

  Lights lights;
  lights.environment.zenith = {0.66, 0.68, 0.72};
  lights.environment.horizon = {0.52, 0.52, 0.52};
  lights.environment.nadir = {0.30, 0.29, 0.28};
  // Key: a large warm box, high on the left and in front, so that a section that faces the eye is lit across its
  // relief. Rim: narrower and cooler, behind on the right; it draws the skin's edge and a sheen on what faces
  // upwards.
  lights.area.push_back(soft_box(center, 0.95 * up - 0.75 * right + 0.8 * near, up, 5 * radius, 3 * radius,
                                 3 * radius, 5.2 * Vec3d(1.03, 1.0, 0.95)));
  lights.area.push_back(soft_box(center, 0.75 * up + 0.75 * right - 0.95 * near, up, 5 * radius, 1.6 * radius,
                                 3 * radius, 3.5 * Vec3d(0.97, 1.0, 1.04)));
  return lights;
}

} // namespace pith
