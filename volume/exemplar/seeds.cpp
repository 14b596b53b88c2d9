// Seeds are bodies of revolution around S, flattened along R: half width w(t) along the long axis, t from −1 (blunt
// end) to 1 (point). Proportions and colours are measured in photographs of a kiwi cut across and along, and of a
// watermelon.
#include "volume/exemplar/seeds.h"

#include "volume/base/image.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"
#include "volume/exemplar/periodic_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pith {

namespace {

using Color = std::array<float, 3>;

/// A colour as measured in a photograph (bytes, sRGB), in linear light.
Color measured(int r, int g, int b) {
  return {linear_from_srgb(r / 255.0f), linear_from_srgb(g / 255.0f), linear_from_srgb(b / 255.0f)};
}
Color mixed(const Color& a, const Color& b, float t) {
  return {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t};
}
float ramp(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

struct SeedShape {
  float half_length; ///< parts of the cube
  float broad, thin; ///< half width along T and along R at the thickest
  float taper;       ///< 0: an ellipsoid; up to 1: drawn out to a point
  float veil;        ///< width of the veil around it, parts of the cube; 0: none
  float veil_alpha;  ///< of the veil where it touches the seed
};

/// Distance inside the seed (negative outside), parts of the cube; exact to first order near the surface.
float inside(const SeedShape& shape, float r, float s, float t) {
  const float along = s / shape.half_length;
  // The blunt half is an ellipsoid's; towards the point the width shrinks with the taper.
  const float narrow = 1.0f - shape.taper * 0.5f * (1.0f + std::clamp(along, -1.0f, 1.0f));
  const float x = r / (shape.thin * narrow), z = t / (shape.broad * narrow);
  const float q = std::sqrt(along * along + x * x + z * z);
  if (q < 1e-6f) return std::min(shape.thin, shape.half_length);
  const float gx = x / (shape.thin * narrow), gz = z / (shape.broad * narrow), gs = along / shape.half_length;
  const float slope = std::sqrt(gx * gx + gz * gz + gs * gs) / q;
  return (1.0f - q) / slope;
}

template <class ColorAt>
Exemplar seed_exemplar(const char* name, const ProceduralOptions& options, const SeedShape& shape,
                       const ColorAt& color_at) {
  const int n = options.resolution;
  Exemplar e;
  e.name = name;
  e.axes = 3;
  e.size = {n, n, n, 1};
  e.channel = {Channel{}, {"alpha", Semantic::scalar, 1, false, 0, 1}};
  e.texel.resize(e.texel_count() * 4);
  const float edge = 0.75f / n; // half of the ramp from nothing to opaque
  parallel_for(n, 1, [&](std::size_t k) {
    std::uint8_t* out = e.at(0, 0, static_cast<int>(k));
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const float r = (i + 0.5f) / n - 0.5f, s = (j + 0.5f) / n - 0.5f, t = (float(k) + 0.5f) / n - 0.5f;
        const float depth = inside(shape, r, s, t);
        const float body = ramp(-edge, edge, depth);
        const float veil =
            shape.veil > 0 ? shape.veil_alpha * ramp(0.0f, 1.0f, 1.0f + std::min(depth, 0.0f) / shape.veil) : 0.0f;
        if (body == 0 && veil == 0) { // nothing to see: what makes a thing of it continues the colours
          out += 4;
          continue;
        }
        const Color color = color_at(r, s, t, depth, body);
        for (const float c : color) *out++ = encoded(e.channel[0], c);
        *out++ = encoded(e.channel[1], std::max(body, veil));
      }
  });
  return e;
}

} // namespace

Exemplar kiwi_seed_exemplar(const ProceduralOptions& options) {
  const SeedShape shape{
      .half_length = 0.40f, .broad = 0.25f, .thin = 0.205f, .taper = 0.42f, .veil = 0.085f, .veil_alpha = 0.42f};
  const Color coat = measured(24, 12, 10), brown = measured(58, 30, 20), sheen = measured(96, 74, 62),
              kernel = measured(38, 22, 16), veil = measured(52, 60, 18);
  const PeriodicNoise pits(hash_of(options.seed, 0x5eed), 22, 22, 22), cloud(hash_of(options.seed, 0x5eee), 4, 4, 4);
  return seed_exemplar("kiwi-seed", options, shape, [=](float r, float s, float t, float depth, float body) {
    // The coat is finely pitted; just beneath it runs a brown line, seen where the seed is cut; a wet sheen on one
    // side.
    const float grain = pits.value(r + 0.5f, s + 0.5f, t + 0.5f), slow = cloud.value(r + 0.5f, s + 0.5f, t + 0.5f);
    Color color = mixed(coat, brown, std::clamp(0.22f + 0.30f * grain + 0.25f * slow, 0.0f, 1.0f));
    color = mixed(color, kernel, 0.5f * ramp(0.03f, 0.09f, depth));
    const float toward = (0.5f * r + 0.6f * t - 0.35f * s) / 0.25f;
    color = mixed(color, sheen, 0.30f * ramp(0.35f, 0.75f, toward) * (1.0f - ramp(0.02f, 0.09f, depth)));
    return mixed(veil, color, body);
  });
}

Exemplar watermelon_seed_exemplar(const ProceduralOptions& options) {
  const SeedShape shape{
      .half_length = 0.37f, .broad = 0.235f, .thin = 0.11f, .taper = 0.48f, .veil = 0.045f, .veil_alpha = 0.5f};
  const Color dark = measured(22, 13, 11), brown = measured(58, 34, 23), rim = measured(92, 60, 38),
              kernel = measured(74, 52, 38), veil = measured(178, 26, 34);
  const PeriodicNoise grain(hash_of(options.seed, 0x3e1), 18, 26, 18), cloud(hash_of(options.seed, 0x3e2), 4, 5, 4);
  return seed_exemplar("watermelon-seed", options, shape, [=](float r, float s, float t, float depth, float body) {
    const float fine = grain.value(r + 0.5f, s + 0.5f, t + 0.5f), slow = cloud.value(r + 0.5f, s + 0.5f, t + 0.5f);
    Color color = mixed(dark, brown, std::clamp(0.30f + 0.20f * fine + 0.35f * slow, 0.0f, 1.0f));
    // A paler rim along the edge of the broad side, a brown kernel inside the shell, wet and deeper red flesh around.
    const float across = std::fabs(r) / shape.thin;
    color = mixed(color, rim, 0.4f * (1.0f - ramp(0.15f, 0.4f, across)) * (1.0f - ramp(0.02f, 0.045f, depth)));
    color = mixed(color, kernel, 0.6f * ramp(0.050f, 0.075f, depth));
    return mixed(veil, color, body);
  });
}

} // namespace pith
