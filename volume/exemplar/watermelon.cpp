// A watermelon, type 1-b: the material changes with depth and is alike in all directions across it. Rind and flesh
// after a photograph of wedges (BSD-3, the Flutter sample Veggie Seasons).
#include "volume/exemplar/paint.h"
#include "volume/exemplar/painters.h"

namespace pith {

using namespace paint;

namespace {

struct Watermelon {
  Watermelon(std::uint64_t seed, bool seeds)
      : with_seeds(seeds), cloud(hash_of(seed, 1), {4, 4, 4}, 3, tile_around),
        grain(hash_of(seed, 2), {34, 40, 34}, 2, tile_around), thread(hash_of(seed, 3), {26, 4, 26}, tile_around),
        border(hash_of(seed, 4), {7, 2, 7}, 2, tile_around),
        cells(hash_of(seed, 5), {22, 26, 22}, 0.45f, tile_around),
        stripe(hash_of(seed, 6), {5, 1, 5}, 3, tile_around), fine(hash_of(seed, 7), {34, 1, 34}, 2, tile_around),
        seed(hash_of(seed, 8), {4, 9, 4}, 0.38f, tile_around) {}

  Material at(float x, float y, float z) const {
    const float slow = cloud(x, y, z), edge = border(x, y, z);
    const float radius =
        std::clamp(radius_at_depth(y) + 0.012f * edge * ramp(0.99f, 0.9f, radius_at_depth(y)), 0.0f, 1.0f);
    Rgb color = color_at(flesh, radius);

    // Juice cells: bright grains with darker walls; they fade out into the rind.
    const float red = 1.0f - ramp(0.80f, 0.88f, radius);
    const ScatteredPoints::Nearest cell = cells.nearest(x, y, z);
    const float wall = 1.0f - ramp(0.0f, 0.22f, cell.second - cell.first);
    const float own = uniform_of(cell.hash) - 0.5f;
    color = scaled(color, 1.0f + red * (0.13f * own + 0.10f * slow + 0.10f * grain(x, y, z)) - 0.10f * red * wall);
    color = mixed(color, sparkle, red * 0.30f * ramp(0.30f, 0.05f, cell.first) * ramp(0.1f, 0.4f, own));
    // Pale threads that run inwards, most in the outer flesh.
    const float threads = ramp(0.35f, 0.85f, thread(x, y, z));
    color = mixed(color, vein, threads * (0.34f * band(0.55f, 0.86f, 0.10f, radius)));
    // The rind's flesh: greenish dots of its bundles.
    color = scaled(color, 1.0f + (1.0f - red) * (0.05f * grain(x, y, z) + 0.03f * slow));

    if (with_seeds) color = seeded(color, x, y, z);

    // Skin: dark and light blotches, waxy and thin.
    const float skin_end = 0.012f + 0.003f * edge;
    if (y < 3.0f * skin_end) {
      const float blotch = ramp(-0.10f, 0.22f, stripe(x, 0, z));
      Rgb skin = mixed(skin_dark, skin_light, blotch * (0.75f + 0.25f * fine(x, 0, z)));
      skin = scaled(skin, 1.0f + 0.16f * fine(x, 0, z));
      color = mixed(skin, color, ramp(0.8f * skin_end, 2.2f * skin_end, y));
    }
    return material(color);
  }

  /// Seeds lie in a shell of the flesh; each is a flattened drop that points to the middle, in a small pale hollow.
  Rgb seeded(Rgb color, float x, float y, float z) const {
    float inside = 0, hollow = 0, rim = 0;
    seed.near(x, y, z, [&](const Point3f& d, std::uint64_t hash) {
      const float center = radius_at_depth(std::clamp(y - d[1], 0.0f, 1.0f));
      if (center < 0.42f || center > 0.76f || uniform_of(hash) < 0.45f) return;
      const float turn = 6.2831853f * uniform_of(hash, 1);
      const float u = d[0] * std::cos(turn) + d[2] * std::sin(turn),
                  v = d[2] * std::cos(turn) - d[0] * std::sin(turn);
      const float size = 0.9f + 0.2f * uniform_of(hash, 2);
      // Half axes in texture widths, which are half the radius at the skin and 1/(2r) of it inside.
      const float length = 0.125f * center * size, width = 0.078f * center * size, thick = 0.040f * center * size;
      const float t = d[1] / length, taper = 1.0f - 0.35f * std::clamp(t, -1.0f, 1.0f);
      const float q = std::sqrt(t * t + (u * u) / (width * width * taper * taper) + (v * v) / (thick * thick));
      inside = std::max(inside, ramp(1.10f, 0.90f, q));
      rim = std::max(rim, ramp(0.70f, 0.95f, q) * ramp(1.12f, 0.95f, q));
      hollow = std::max(hollow, ramp(1.75f, 1.05f, q));
    });
    color = mixed(color, hollow_color, 0.55f * hollow);
    color = mixed(color, seed_color, inside);
    return mixed(color, seed_rim, 0.45f * rim * inside);
  }

  bool with_seeds;
  FractalNoise cloud, grain;
  TileNoise thread;
  FractalNoise border;
  ScatteredPoints cells;
  FractalNoise stripe, fine;
  ScatteredPoints seed;

  std::array<Stop, 11> flesh{{{0.00f, measured(236, 92, 88)},
                              {0.25f, measured(232, 74, 74)},
                              {0.55f, measured(228, 66, 66)},
                              {0.76f, measured(230, 72, 70)},
                              {0.83f, measured(234, 104, 92)},
                              {0.88f, measured(240, 178, 150)},
                              {0.915f, measured(238, 222, 184)},
                              {0.945f, measured(226, 230, 176)},
                              {0.97f, measured(186, 208, 122)},
                              {0.985f, measured(132, 172, 74)},
                              {1.00f, measured(84, 130, 44)}}};
  Rgb sparkle = measured(255, 176, 160), vein = measured(246, 150, 132);
  Rgb skin_dark = measured(22, 56, 22), skin_light = measured(104, 142, 62);
  Rgb seed_color = measured(38, 20, 14), seed_rim = measured(92, 56, 34), hollow_color = measured(244, 140, 124);
};

} // namespace

Exemplar watermelon_exemplar(const ProceduralOptions& options, bool seeds) {
  const Watermelon watermelon(options.seed, seeds);
  return painted({.name = seeds ? "watermelon" : "watermelon-flesh",
                  .wrap = wrap_around,
                  .skin = true,
                  .at = [&](float x, float y, float z) { return watermelon.at(x, y, z); }},
                 options);
}

} // namespace pith
