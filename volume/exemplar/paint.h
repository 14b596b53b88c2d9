#pragma once
// What the painters of procedural exemplars share: colours, and the loop that turns a function of a point into
// texels.
#include "volume/base/parallel.h"
#include "volume/exemplar/procedural.h"
#include "volume/exemplar/tile_noise.h"

#include <algorithm>
#include <functional>
#include <span>

namespace pith::paint {

/// A colour in linear light.
struct Rgb {
  float r = 0, g = 0, b = 0;
};
inline Rgb mixed(const Rgb& a, const Rgb& b, float t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}
inline Rgb scaled(const Rgb& a, float s) { return {a.r * s, a.g * s, a.b * s}; }

/// A colour given as bytes of sRGB, as read off a photograph.
Rgb measured(int r, int g, int b);

/// 0 below `low`, 1 above `high`, smooth between.
inline float ramp(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}
/// 1 between two places and 0 beyond borders of width `soft`.
inline float band(float low, float high, float soft, float x) {
  return ramp(low - soft, low + soft, x) * (1.0f - ramp(high - soft, high + soft, x));
}

struct Stop {
  float at;
  Rgb color;
};
/// The colour at a place between stops in ascending order; constant beyond the ends.
Rgb color_at(std::span<const Stop> stops, float at);

/// What a point is made of: the components of all channels, in their order, decoded (linear light for colours).
using Material = std::array<float, max_components>;
inline Material material(const Rgb& color) { return {color.r, color.g, color.b}; }

/// The channels beside colour that exemplars here have.
Channel alpha_channel();                       ///< scalar "alpha": coverage, 0 … 1
Channel height_channel(float low, float high); ///< height "height", mm
Channel extinction_channel(float high);        ///< scalar "extinction", 1/mm
Channel fiber_channel();                       ///< direction "fiber", components in [−1, 1]

/// One exemplar to paint.
struct Canvas {
  std::string name;
  std::array<Wrap, 3> wrap{Wrap::repeat, Wrap::repeat, Wrap::repeat};
  std::vector<Channel> channel{Channel{}};
  bool skin = false; ///< the row of lowest y is read at the depth of the skin, whatever the resolution
  /// The material at a point of the unit cube; called from several threads.
  std::function<Material(float x, float y, float z)> at;
};
inline constexpr std::array<Wrap, 3> wrap_around{Wrap::repeat, Wrap::clamp, Wrap::repeat};

/// Texels of a canvas. Up to 64 texels along an axis each is the mean of eight points in it, in decoded values, so
/// that coarse exemplars look like fine ones seen from further away. In parallel; the same bytes for any number of
/// threads.
Exemplar painted(const Canvas& canvas, const ProceduralOptions& options);

} // namespace pith::paint
