#pragma once
// A view that shows all pieces.
#include "raytrace/scene.h"
#include "volume/base/view.h"

namespace pith {

struct FramingOptions {
  /// From the subject to the eye, any length. Zero: chosen so that the sections are as large as they can be in the
  /// picture, with what hides them taken into account, from a little above (where there is no ground, also from
  /// below).
  Vec3d direction{0, 0, 0};
  double vertical_angle = 0.45; ///< radians; 0: orthographic
  double aspect = 4.0 / 3.0;    ///< width / height
  double margin = 0.2;          ///< free border, as a fraction of the picture
};

/// The share (0 to 1) of the area of all sections that a view shows, turned towards the eye: two halves that face one
/// another show less than half. 1 where there are no sections.
double section_share(const Scene& scene, const View& view);

/// The closest view along the direction in which every point of the pieces lies inside the border. `up` is the
/// scene's. Cost of choosing a direction: about 100 × 1000 rays.
View framed_view(const Scene& scene, const FramingOptions& options = {});

} // namespace pith
