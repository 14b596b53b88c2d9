#pragma once
// From radiance to what a screen shows.
#include "volume/base/image.h"

namespace pith {

struct ToneOptions {
  enum class Curve {
    neutral, ///< colours below 0.8 stay as they are, highlights roll off (Khronos PBR Neutral)
    clip     ///< nothing but the exposure and a clip to [0, 1]
  };
  Curve curve = Curve::neutral;
  double exposure = 0; ///< stops: radiance is multiplied by 2^exposure
};

/// Display light in [0, 1], still linear: writers of 8-bit pictures apply the sRGB curve. Red, green, blue
/// (premultiplied by alpha where there are four channels); alpha is kept.
Image tone_mapped(const Image& radiance, const ToneOptions& options = {});

} // namespace pith
