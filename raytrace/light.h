#pragma once
// The light of a picture: surroundings and rectangles that glow. Plain data.
#include "volume/base/image.h"
#include "volume/base/types.h"
#include "volume/base/view.h"

namespace pith {

/// Light from infinitely far away.
struct Environment {
  /// Radiance by direction: latitude-longitude, 3 or 4 channels, linear; the top row is straight up (Scene's `up`),
  /// the middle column is looked at along the turned `forward` of light_frame(). Empty: the gradient below.
  Image image;
  /// Radiance of a gradient sky where there is no image; equal: a constant sky.
  Vec3d zenith{1, 1, 1}, horizon{1, 1, 1}, nadir{1, 1, 1};
  double scale = 1; ///< multiplies everything; ≥ 0
  double turn = 0;  ///< radians, counter-clockwise about `up`
};

/// A rectangle that emits `radiance` to the side that edge_u × edge_v points to.
struct AreaLight {
  Vec3d center{0, 0, 0};                  ///< mm
  Vec3d edge_u{1, 0, 0}, edge_v{0, 1, 0}; ///< full edges, mm, at right angles
  Vec3d radiance{1, 1, 1};
  bool visible = false; ///< to camera rays; reflections always see it
};

struct Lights {
  Environment environment;
  std::vector<AreaLight> area;
};

/// Throws InvalidInput, naming the light, when numbers are negative or not finite, an edge has no length, or the
/// environment's image is not 3 or 4 channels.
void validate(const Lights& lights);

/// The built-in set: a large soft box from the upper left of the camera, a narrow one behind for the rim, and a soft
/// sky. Scaled to a sphere (`center`, `radius`) that holds the subject; a white matte plane facing `up` there shows
/// about 0.8 without any further exposure.
Lights default_lights(const View& view, const Vec3d& center, double radius, const Vec3d& up);

/// Only the given picture of the surroundings.
Lights environment_lights(Image latitude_longitude, double scale = 1, double turn = 0);

/// Stops of exposure at which a white matte plane that faces `up` at `subject` shows 0.8: for pictures of
/// surroundings, whose scale nobody knows. 0 where there is no light.
double neutral_exposure(const Lights& lights, const Vec3d& subject, const Vec3d& up);

} // namespace pith
