// An almond to paste: in the middle of the cube, its long axis along S as that of the seeds, flat across R, with the
// channel "alpha": 1 inside, 0 outside. Its colours go on outside the border, so that filtering never darkens the
// rim.
#include "volume/exemplar/paint.h"
#include "volume/exemplar/painters.h"

namespace pith {

using namespace paint;

namespace {

/// Where a point lies in a drop-shaped body: 1 on its surface, less inside.
struct Drop {
  float half_length, half_width, half_thickness; ///< along z, x and y, of the cube
  float taper;                                   ///< how much narrower it is at high z than at low z
  float at(float x, float y, float z) const {
    const float t = std::clamp((z - 0.5f) / half_length, -1.3f, 1.3f);
    const float narrow = 1.0f - taper * t;
    const float u = (x - 0.5f) / (half_width * narrow), v = (y - 0.5f) / (half_thickness * narrow);
    return std::sqrt(u * u + v * v + t * t);
  }
};

Canvas thing(const char* name) {
  Canvas canvas;
  canvas.name = name;
  canvas.wrap = {Wrap::clamp, Wrap::clamp, Wrap::clamp};
  canvas.channel = {Channel{}, alpha_channel()};
  return canvas;
}

Material cut_out(const Rgb& color, float q, float half_thickness) {
  Material m = material(color);
  const float soft = 0.008f / half_thickness; // about a texel of 128 either side
  m[3] = 1.0f - ramp(1.0f - soft, 1.0f + soft, q);
  return m;
}

} // namespace

Exemplar almond_exemplar(const ProceduralOptions& options) {
  constexpr Tiling tiling{false, false, false};
  const FractalNoise grain(hash_of(options.seed, 1), {16, 16, 16}, 3, tiling),
      groove(hash_of(options.seed, 2), {22, 22, 3}, 2, tiling);
  const Drop drop{0.45f, 0.28f, 0.17f, 0.28f};
  const Rgb coat = measured(148, 84, 42), coat_dark = measured(98, 50, 24), inner = measured(246, 228, 188),
            rim = measured(236, 208, 156), gap = measured(214, 184, 130);
  Canvas canvas = thing("almond");
  // The shape below is long along its z, broad along x and thin along y.
  canvas.at = [&](float thin, float along, float broad) {
    const float x = broad, y = thin, z = along;
    const float q = drop.at(x, y, z) * (1.0f + 0.012f * groove(x, y, z));
    Rgb color = mixed(coat, coat_dark, ramp(-0.2f, 0.6f, groove(x, y, z) + 0.4f * grain(x, y, z)));
    Rgb flesh = scaled(mixed(inner, rim, ramp(0.55f, 0.9f, q)), 1.0f + 0.05f * grain(x, y, z));
    flesh = mixed(flesh, gap, 0.8f * ramp(0.014f, 0.004f, std::fabs(y - 0.5f))); // between its two halves
    color = mixed(flesh, color, ramp(0.90f, 0.95f, q));
    return cut_out(color, q, drop.half_thickness);
  };
  return painted(canvas, options);
}

} // namespace pith
