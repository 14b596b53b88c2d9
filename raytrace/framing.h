#pragma once
// A view that shows all pieces.
#include "raytrace/scene.h"
#include "volume/base/view.h"

namespace pith {

struct FramingOptions {
  /// From the subject to the eye, any length. Zero: chosen so that the sections are seen well, from a little above.
  Vec3d direction{0, 0, 0};
  double vertical_angle = 0.45; ///< radians; 0: orthographic
  double aspect = 4.0 / 3.0;    ///< width / height
  double margin = 0.2;          ///< free border, as a fraction of the picture
};

/// The closest view along the direction in which every point of the pieces lies inside the border. `up` is the
/// scene's.
View framed_view(const Scene& scene, const FramingOptions& options = {});

} // namespace pith
