#pragma once
// A picture in memory.
#include <cstddef>
#include <vector>

namespace pith {

/// Row-major, top row first, channels interleaved, linear light (Rec.709 primaries) unless the holder says otherwise.
struct Image {
  int width = 0, height = 0, channels = 0;
  std::vector<float> pixel; ///< width · height · channels

  Image() = default;
  Image(int width, int height, int channels)
      : width(width), height(height), channels(channels), pixel(std::size_t(width) * height * channels, 0.0f) {}
  float* at(int x, int y) { return pixel.data() + (std::size_t(y) * width + x) * channels; }
  const float* at(int x, int y) const { return pixel.data() + (std::size_t(y) * width + x) * channels; }
};

/// The transfer curve of sRGB (IEC 61966-2-1), both ways, for one component in [0, 1].
float srgb_from_linear(float linear);
float linear_from_srgb(float encoded);

} // namespace pith
