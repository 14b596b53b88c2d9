// The Khronos PBR Neutral tone mapper (Khronos Group, 2024): colours between the toe and 0.8 keep hue, saturation and
// brightness; brighter ones are compressed and lose saturation. Departure: no subtraction of the Fresnel toe, because
// dark colours here are shown as they are.
#include "raytrace/tone.h"

#include <algorithm>
#include <cmath>

namespace pith {

Image tone_mapped(const Image& radiance, const ToneOptions& options) {
  constexpr float start = 0.8f, desaturation = 0.15f;
  const float gain = std::exp2(static_cast<float>(options.exposure));
  Image result = radiance;
  const int colors = std::min(3, radiance.channels);
  const std::size_t count = std::size_t(radiance.width) * radiance.height;
  for (std::size_t i = 0; i < count; ++i) {
    float* p = result.pixel.data() + i * radiance.channels;
    float peak = 0;
    for (int c = 0; c < colors; ++c) {
      p[c] = std::isfinite(p[c]) ? std::max(0.0f, p[c] * gain) : 0.0f;
      peak = std::max(peak, p[c]);
    }
    if (options.curve == ToneOptions::Curve::neutral && peak > start) {
      constexpr float room = 1 - start;
      const float shown = 1 - room * room / (peak + room - start);
      const float keep = 1 / (desaturation * (peak - shown) + 1);
      for (int c = 0; c < colors; ++c) p[c] = shown + keep * (p[c] * (shown / peak) - shown);
    }
    for (int c = 0; c < colors; ++c) p[c] = std::clamp(p[c], 0.0f, 1.0f);
  }
  return result;
}

} // namespace pith
