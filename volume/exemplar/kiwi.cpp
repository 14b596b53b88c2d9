// A kiwi's flesh, drawn from photographs of two sections (across and along) and of the skin: where the layers lie and
// what colour they have was measured there, as the part of the fruit's radius; kiwi_radius_at_depth turns that into
// depth.
#include "volume/exemplar/kiwi.h"

#include "volume/base/image.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"
#include "volume/exemplar/kiwi_parts.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pith {

namespace {

struct Rgb {
  float r = 0, g = 0, b = 0;
};
Rgb mixed(const Rgb& a, const Rgb& b, float t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}
Rgb scaled(const Rgb& a, float s) { return {a.r * s, a.g * s, a.b * s}; }

/// A colour as measured in a photograph (bytes, sRGB), in linear light.
Rgb measured(int r, int g, int b) {
  return {linear_from_srgb(r / 255.0f), linear_from_srgb(g / 255.0f), linear_from_srgb(b / 255.0f)};
}

float ramp(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// Measured colours (photograph's median at the radius; pale rays and dark locules at the 80th and 15th percentile).
struct Palette {
  struct Stop {
    float radius;
    Rgb color;
  };
  std::vector<Stop> flesh{
      {0.00f, measured(224, 216, 178)}, {0.12f, measured(218, 212, 167)}, {0.18f, measured(211, 205, 152)},
      {0.25f, measured(186, 186, 112)}, {0.30f, measured(146, 150, 66)},  {0.42f, measured(126, 136, 52)},
      {0.58f, measured(123, 141, 35)},  {0.72f, measured(118, 137, 26)},  {0.86f, measured(110, 126, 18)},
      {0.95f, measured(100, 112, 12)},  {1.00f, measured(92, 98, 14)}};
  Rgb locule = measured(72, 80, 26), locule_inner = measured(104, 98, 40);
  Rgb ray = measured(158, 170, 92);
  Rgb speck = measured(186, 196, 104);
  Rgb seed = measured(30, 12, 9), seed_sheen = measured(52, 25, 18), seed_behind = measured(54, 48, 38);
  float locule_blend = 0.86f, streak_blend = 0.75f, ray_begin = 0.20f, ray_full = 0.31f, ray_gain = 1.0f,
        speck_blend = 0.68f, speck_length = 1.0f;
  Rgb rim = measured(84, 58, 14), skin_dark = measured(92, 50, 8), skin = measured(135, 93, 48),
      skin_light = measured(212, 166, 114);

  Rgb flesh_at(float radius) const {
    std::size_t i = 1;
    while (i + 1 < flesh.size() && flesh[i].radius < radius) ++i;
    const float t = (radius - flesh[i - 1].radius) / (flesh[i].radius - flesh[i - 1].radius);
    return mixed(flesh[i - 1].color, flesh[i].color, std::clamp(t, 0.0f, 1.0f));
  }
  Rgb skin_at(float brightness) const {
    return brightness < 0.5f ? mixed(skin_dark, skin, 2.0f * brightness)
                             : mixed(skin, skin_light, 2.0f * brightness - 1.0f);
  }
};

/// For flesh whose seeds are things of their own; adjusted by eye against the same photographs. Locules are little
/// darker than the flesh around them (much of their darkness above is seeds that shine through), and the core has an
/// outline.
Palette flesh_palette() {
  Palette p;
  p.flesh = {{0.00f, measured(226, 219, 182)},  {0.12f, measured(222, 216, 174)}, {0.19f, measured(216, 212, 164)},
             {0.225f, measured(207, 206, 148)}, {0.25f, measured(176, 182, 102)}, {0.28f, measured(140, 152, 62)},
             {0.34f, measured(128, 144, 50)},   {0.42f, measured(126, 142, 46)},  {0.58f, measured(127, 147, 38)},
             {0.72f, measured(122, 143, 30)},   {0.86f, measured(112, 130, 20)},  {0.95f, measured(100, 114, 13)},
             {1.00f, measured(92, 98, 14)}};
  p.locule = measured(80, 98, 24);
  p.locule_inner = measured(104, 112, 36);
  p.ray = measured(170, 182, 104);
  p.locule_blend = 0.62f;
  p.streak_blend = 0.40f;
  p.ray_begin = 0.22f;
  p.ray_full = 0.27f;
  p.ray_gain = 1.1f;
  p.speck = measured(196, 206, 122);
  p.speck_blend = 0.62f;
  p.speck_length = 0.62f;
  return p;
}

/// The fields of one exemplar; constant once made.
struct Fields {
  explicit Fields(std::uint64_t seed)
      : warp(kiwi::locule_warp(seed)), locule(key(seed, 0), kiwi_locules, 2, 6),
        ray(key(seed, 1), kiwi_locules, 3, 5), fiber(key(seed, 2), 64, 6, 28),
        hatch(key(seed, 8), 4 * kiwi_locules, 3, 14), cell(key(seed, 3), 60, 64, 60), cloud(key(seed, 4), 5, 5, 4),
        streak(key(seed, 5), 3 * kiwi_locules, 6, 9), core(key(seed, 6), 30, 40, 3), rim(key(seed, 7), 14, 1, 14) {}
  static std::uint64_t key(std::uint64_t seed, int field) { return hash_of(seed, kiwi::stage_field, field); }

  PeriodicNoise warp, locule, ray;
  PeriodicNoise fiber, hatch; ///< fine and less fine, long along S
  PeriodicNoise cell;         ///< grain
  PeriodicNoise cloud;        ///< slow changes of brightness
  PeriodicNoise streak;       ///< between core and seeds
  PeriodicNoise core;         ///< long along T
  PeriodicNoise rim;          ///< thickness of the skin
};

/// One line of constant y and z; storage is reused from line to line.
struct Line {
  PeriodicNoise::Row warp, locule, ray, fiber, hatch, cell, cloud, streak, core, rim;

  void read(const Fields& fields, float y, float z) {
    fields.warp.read(y, z, warp);
    fields.locule.read(y, z, locule);
    fields.ray.read(y, z, ray);
    fields.fiber.read(y, z, fiber);
    fields.hatch.read(y, z, hatch);
    fields.cell.read(y, z, cell);
    fields.cloud.read(y, z, cloud);
    fields.streak.read(y, z, streak);
    fields.core.read(y, z, core);
    fields.rim.read(y, z, rim);
  }
};

/// What of a flesh colour depends on depth alone.
struct Depth {
  Depth(const Palette& palette, float depth) : depth(depth), radius(kiwi_radius_at_depth(depth)) {
    flesh = palette.flesh_at(radius);
    ray_strength = ramp(palette.ray_begin, palette.ray_full, radius);
    ray_contrast = 0.75f + 0.35f * ramp(0.32f, 0.50f, radius);
    streak_strength = ramp(0.20f, 0.27f, radius) * (1.0f - ramp(0.30f, 0.42f, radius));
    wisp_strength = ramp(0.42f, 0.58f, radius) * (1.0f - ramp(0.66f, 0.93f, radius));
    core_strength = 1.0f - ramp(0.16f, 0.28f, radius);
    locule_color = mixed(palette.locule_inner, palette.locule, ramp(0.27f, 0.37f, radius));
    grain_strength = ramp(0.05f, 0.35f, radius);
  }
  float depth, radius;
  Rgb flesh, locule_color;
  float ray_strength, ray_contrast, streak_strength, wisp_strength, core_strength, grain_strength;
};

Rgb flesh_color(const Palette& palette, const Line& line, const Depth& at, float x) {
  // The core's border and the flesh's colours stray a little with the rays: shift the radius at which they are read.
  const float fiber = line.fiber.at(x), cell = line.cell.at(x), cloud = line.cloud.at(x);
  Rgb color = at.flesh;

  // Where among the locules: `across` runs from −1/2 to 1/2 through locule `index`; the nearest ray stands at ±1/2.
  const float place = (x + kiwi::warp_amplitude / kiwi_locules * line.warp.at(x)) * kiwi_locules;
  const float below = std::floor(place);
  const float across = place - below - 0.5f;
  const int index = ((int(below) % kiwi_locules) + kiwi_locules) % kiwi_locules;
  const int ray_index = (index + (across > 0 ? 1 : 0)) % kiwi_locules;
  const float from_ray = 0.5f - std::fabs(across);

  // Pale rays: narrow by the core, fading outwards, each in its own way.
  const float own = line.ray.corner(ray_index);
  const float fade = 1.0f - ramp(0.50f + 0.08f * own, 0.86f + 0.10f * own, at.radius);
  const float ray_width = 0.15f + 0.05f * own + 0.10f * ramp(0.5f, 0.8f, at.radius);
  const float ray = (1.0f - ramp(0.25f * ray_width, ray_width, from_ray)) * at.ray_strength * fade;
  const float ray_blend = ray * (0.46f + 0.26f * own + 0.26f * fiber) * at.ray_contrast * palette.ray_gain;

  // Dark lens-shaped locules between them.
  const float vary = line.locule.corner(index);
  const float inner = 0.275f + 0.015f * vary, outer = 0.605f + 0.050f * vary;
  const float s = std::clamp((at.radius - inner) / (outer - inner), 0.0f, 1.0f);
  const float lens = (0.37f + 0.04f * vary) * std::sqrt(4.0f * s * (1.0f - s) * (1.25f - 0.5f * s));
  const float locule =
      ramp(-0.07f, 0.10f, lens - std::fabs(across)) * ramp(0.0f, 0.30f, s) * (1.0f - ramp(0.55f, 1.0f, s));
  color = mixed(color, at.locule_color, std::min(1.0f, locule * (palette.locule_blend + 0.14f * cloud)));
  color = mixed(color, palette.ray, std::clamp(ray_blend, 0.0f, 1.0f));

  // Wisps: thinner pale lines between the rays, further out.
  const float wisp = std::max(0.0f, line.hatch.at(x) - 0.15f) * at.wisp_strength * (0.7f + 0.3f * cloud);
  color = mixed(color, palette.ray, 0.55f * wisp);

  // Fine dark strokes between the seeds and the core.
  const float streak = std::max(0.0f, line.streak.at(x) + 0.1f) * at.streak_strength;
  color = mixed(color, palette.locule_inner, palette.streak_blend * streak);

  // Translucent unevenness: slow clouds, radial fibres, cells; along T in the core.
  const float grain = at.grain_strength * (0.09f * cloud + 0.16f * fiber + 0.12f * cell);
  return scaled(color,
                1.0f + grain + 0.06f * at.core_strength * (line.core.at(x) * (1.0f - at.depth * at.depth * 0.5f)));
}

/// Bytes for linear values in steps of 1/65535: exact to half a step of the byte everywhere.
std::vector<std::uint8_t> encoding_table() {
  const Channel channel;
  std::vector<std::uint8_t> table(65536);
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = std::uint8_t(std::lround(255.0f * std::clamp(srgb_from_linear(float(i) / 65535.0f), 0.0f, 1.0f)));
  return table;
}

Exemplar kiwi_of(const ProceduralOptions& options, bool with_seeds) {
  const int n = options.resolution;
  const int parts = std::max(1, (127 + n) / n); // sub-texels along each axis where texels are coarse
  const int fine = n * parts;

  Exemplar exemplar;
  exemplar.name = with_seeds ? "kiwi" : "kiwi-flesh";
  exemplar.axes = 3;
  exemplar.size = {n, n, n, 1};
  exemplar.wrap = {Wrap::repeat, Wrap::clamp, Wrap::repeat, Wrap::clamp};
  exemplar.channel = {Channel{}};
  exemplar.texel.resize(exemplar.texel_count() * 3);

  const Palette palette = with_seeds ? Palette() : flesh_palette();
  const Fields fields(options.seed);
  const std::vector<KiwiSeed> seeds = with_seeds ? kiwi_seeds(options.seed) : std::vector<KiwiSeed>();
  std::vector<KiwiSeed> specks = kiwi::specks(options.seed);
  for (KiwiSeed& speck : specks)
    speck.half_length = std::max(speck.half_width, palette.speck_length * speck.half_length);
  const std::vector<float> hair = kiwi::hair_brightness(options.seed, fine);
  const std::vector<std::uint8_t> byte = encoding_table();
  constexpr float skin_end = 0.014f, rim_end = 0.034f; // depths: 0.2 mm of skin, browned flesh under it

  parallel_for(n, 1, [&](std::size_t slice) {
    Line line;
    kiwi::SliceThings things;
    std::vector<Rgb> sum(std::size_t(n) * n);
    for (int part = 0; part < parts; ++part) {
      const int k = int(slice) * parts + part;
      const float z = (float(k) + 0.5f) / fine;
      kiwi::draw_things(seeds, specks, fine, z, things);
      for (int j = 0; j < fine; ++j) {
        // The outermost texels are skin whatever their size: the outside reads nothing else.
        const float y = j < parts ? 0.5f / std::max(fine, 128) : (float(j) + 0.5f) / fine;
        const Depth at(palette, y);
        line.read(fields, y, z);
        const float* hair_row = hair.data() + std::size_t(k) * fine;
        Rgb* target = sum.data() + std::size_t(j / parts) * n;
        for (int i = 0; i < fine; ++i) {
          const float x = (float(i) + 0.5f) / fine;
          const std::size_t here = std::size_t(j) * fine + i;
          Rgb color = flesh_color(palette, line, at, x);
          color = mixed(color, palette.speck, palette.speck_blend * things.speck[here]);
          color = mixed(color, palette.seed_behind, 0.65f * things.shade[here]);
          if (things.seed[here] > 0)
            color = mixed(color, mixed(palette.seed, palette.seed_sheen, 0.5f + 0.5f * line.cell.at(x)),
                          things.seed[here]);
          if (y < 2.0f * rim_end) {
            const float thick = 1.0f + 0.25f * line.rim.at(x);
            color = mixed(color, palette.rim, 1.0f - ramp(skin_end * thick, rim_end * thick, y));
            color =
                mixed(color, palette.skin_at(hair_row[i]), 1.0f - ramp(0.6f * skin_end * thick, skin_end * thick, y));
          }
          Rgb& texel = target[i / parts];
          texel = {texel.r + color.r, texel.g + color.g, texel.b + color.b};
        }
      }
    }
    const float unit = 65535.0f / float(parts * parts * parts);
    std::uint8_t* out = exemplar.texel.data() + slice * n * n * 3;
    for (const Rgb& texel : sum)
      for (const float value : {texel.r, texel.g, texel.b})
        *out++ = byte[std::size_t(std::clamp(value * unit + 0.5f, 0.0f, 65535.0f))];
  });
  return exemplar;
}

} // namespace

Exemplar kiwi_exemplar(const ProceduralOptions& options) { return kiwi_of(options, true); }
Exemplar kiwi_flesh_exemplar(const ProceduralOptions& options) { return kiwi_of(options, false); }

} // namespace pith
