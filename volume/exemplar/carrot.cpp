// A carrot's root, type 2-b: skin with creases around, deep orange phloem, a pale ring of cambium at half the radius,
// yellow xylem with rays; fibres run along T.
#include "volume/exemplar/paint.h"
#include "volume/exemplar/painters.h"

namespace pith {

using namespace paint;

namespace {

struct Carrot {
  explicit Carrot(std::uint64_t seed)
      : cloud(hash_of(seed, 1), {4, 3, 3}, 2, tile_around), fiber(hash_of(seed, 2), {44, 40, 5}, tile_around),
        grain(hash_of(seed, 3), {72, 72, 40}, tile_around), warp(hash_of(seed, 4), {7, 5, 1}, tile_around),
        ring(hash_of(seed, 5), {9, 2, 3}, tile_around), ray(hash_of(seed, 6), {rays, 2, 4}, tile_around),
        crease(hash_of(seed, 7), {5, 1, 46}, tile_around), scar(hash_of(seed, 8), {5, 1, 8}, 0.45f, tile_around),
        mottle(hash_of(seed, 9), {6, 1, 9}, 3, tile_around), hair(hash_of(seed, 10), {90, 24, 6}, tile_around) {}

  Material at(float x, float y, float z) const {
    const float slow = cloud(x, y, z), stray = ring(x, y, z);
    const float radius = std::clamp(radius_at_depth(y) + 0.016f * stray, 0.0f, 1.0f);
    Rgb color = color_at(flesh, radius);

    // Rays: pale lines from the core outwards, stronger and wider in the xylem, dotted in the phloem.
    const float place = (x + 0.03f * warp(x, y, z)) * rays;
    const float across = std::fabs(place - std::floor(place) - 0.5f); // 0.5 at a ray's middle
    const float own = ray(x, y, z);
    const float core = 1.0f - ramp(0.40f, 0.47f, radius);
    const float width = 0.10f + 0.06f * own + 0.10f * core;
    const float line = ramp(0.5f - width, 0.5f - 0.3f * width, across);
    const float threads = ramp(-0.1f, 0.7f, hair(x, y, z));
    color = mixed(color, core > 0.5f ? xylem_ray : phloem_ray,
                  line * (0.30f + 0.25f * own) * (1.0f - 0.45f * core) * ramp(0.20f, 0.34f, radius) *
                      (1.0f - ramp(0.80f, 0.95f, radius)));
    color =
        mixed(color, phloem_ray, 0.20f * threads * ramp(0.46f, 0.55f, radius) * (1.0f - ramp(0.88f, 0.97f, radius)));
    // Darker vessels between the rays of the core.
    color = mixed(color, vessel, 0.35f * core * ramp(0.05f, 0.6f, fiber(x, y, z)) * ramp(0.05f, 0.2f, radius));

    // The cambium: a thin, pale and slightly glassy line.
    color = mixed(color, cambium, 0.75f * band(0.445f, 0.470f, 0.012f, radius));

    color = scaled(color, 1.0f + 0.07f * slow + 0.06f * fiber(x, y, z) + 0.07f * grain(x, y, z));

    // Skin: thin, browner, with creases and scars that run around.
    const float thickness = 0.018f + 0.006f * stray;
    if (y < 2.5f * thickness) {
      const float patches = mottle(x, 0, z);
      Rgb skin = mixed(skin_color, skin_light, ramp(-0.3f, 0.7f, patches));
      skin = scaled(skin, 1.0f + 0.10f * grain(x, 0, z) + 0.06f * hair(x, 0, z));
      skin = mixed(skin, skin_dark, 0.55f * ramp(0.35f, 0.75f, crease(x, 0, z) + 0.25f * patches));
      float mark = 0;
      scar.near(x, 0.5f, z, [&](const Point3f& d, std::uint64_t hash) {
        if (uniform_of(hash) < 0.35f) return;
        const float length = 0.04f + 0.07f * uniform_of(hash, 1), bend = 0.25f * (uniform_of(hash, 2) - 0.5f);
        const float u = d[0] / length, v = (d[2] + bend * length * (u * u - 0.4f)) / 0.007f;
        mark = std::max(mark, ramp(1.3f, 0.6f, std::sqrt(u * u + v * v)));
      });
      skin = mixed(skin, scar_color, 0.8f * mark);
      color = mixed(skin, color, ramp(0.5f * thickness, 1.6f * thickness, y));
    }
    return material(color);
  }

  static constexpr int rays = 9; ///< in a texture width; 4π r² widths lie around the part r of the radius
  FractalNoise cloud;
  TileNoise fiber, grain, warp, ring, ray, crease;
  ScatteredPoints scar;
  FractalNoise mottle;
  TileNoise hair;

  std::array<Stop, 9> flesh{{{0.00f, measured(240, 176, 70)},
                             {0.10f, measured(244, 172, 62)},
                             {0.30f, measured(246, 158, 44)},
                             {0.43f, measured(243, 146, 34)},
                             {0.49f, measured(238, 112, 18)},
                             {0.62f, measured(236, 106, 14)},
                             {0.85f, measured(232, 98, 12)},
                             {0.96f, measured(226, 90, 12)},
                             {1.00f, measured(212, 84, 16)}}};
  Rgb xylem_ray = measured(253, 206, 112), phloem_ray = measured(248, 158, 60), vessel = measured(222, 120, 24);
  Rgb cambium = measured(254, 204, 104);
  Rgb skin_color = measured(216, 96, 30), skin_light = measured(232, 122, 48), skin_dark = measured(168, 70, 26),
      scar_color = measured(126, 66, 38);
};

} // namespace

float radius_at_depth(float depth) { return std::sqrt(std::max(0.0f, 1.0f - depth)); }

Exemplar carrot_exemplar(const ProceduralOptions& options) {
  const Carrot carrot(options.seed);
  return painted({.name = "carrot",
                  .wrap = wrap_around,
                  .skin = true,
                  .at = [&](float x, float y, float z) { return carrot.at(x, y, z); }},
                 options);
}

} // namespace pith
