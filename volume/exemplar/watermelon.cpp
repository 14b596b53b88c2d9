// Watermelons. Type 1-b: the material changes with depth and is alike in all directions across it, so that the skin
// is blotched. Type 2-b: the skin's stripes and the flesh's threads run along T, from pole to pole. Rind and flesh
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
    const float radius = radius_at(x, y, z);
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

  /// The part of the radius, a little uneven where one material goes over into another.
  float radius_at(float x, float y, float z) const {
    const float radius = radius_at_depth(y);
    return std::clamp(radius + 0.012f * border(x, y, z) * ramp(0.99f, 0.9f, radius), 0.0f, 1.0f);
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

/// The same fruit with a direction. Around a fruit lie about 4π texture widths, so one dark stripe in each.
struct StripedWatermelon {
  explicit StripedWatermelon(std::uint64_t seed)
      : flesh(seed, false), sway(hash_of(seed, 11), {2, 1, 2}, 2, tile_around),
        jag(hash_of(seed, 12), {6, 1, 9}, 3, tile_around), swell(hash_of(seed, 13), {2, 1, 3}, 2, tile_around),
        mottle(hash_of(seed, 14), {14, 1, 9}, 3, tile_around), net(hash_of(seed, 15), {14, 1, 6}, 0.48f, tile_around),
        fleck(hash_of(seed, 16), {60, 1, 44}, 2, tile_around), thread(hash_of(seed, 17), {34, 26, 4}, 2, tile_around),
        cells(hash_of(seed, 18), {30, 34, 17}, 0.48f, tile_around),
        patch(hash_of(seed, 19), {4, 4, 2}, 3, tile_around) {}

  Material at(float x, float y, float z) const {
    const float edge = flesh.border(x, y, z);
    const float radius = flesh.radius_at(x, y, z);
    const float red = 1.0f - ramp(0.80f, 0.90f, radius);
    Rgb color = color_at(stops, radius);

    // Soft clouds, and juice cells that are drawn out along the axis, each of its own brightness, walls paler. On the
    // axis itself all of R lies in one place, so that nothing of it may be seen there.
    const float cloud = patch(x, y, z), celled = red * ramp(0.02f, 0.22f, radius);
    color = mixed(color, pale, red * 0.34f * ramp(0.05f, 0.65f, cloud));
    color = mixed(color, deep, red * 0.40f * ramp(0.05f, 0.65f, -cloud));
    const ScatteredPoints::Nearest cell = cells.nearest(x, y, z);
    const float own = uniform_of(cell.hash) - 0.5f;
    color = scaled(color, 1.0f + celled * (0.17f * own + 0.22f * flesh.grain(x, y, z)));
    color = mixed(color, flesh.sparkle, celled * 0.13f * (1.0f - ramp(0.0f, 0.22f, cell.second - cell.first)));
    color = mixed(color, flesh.sparkle, celled * 0.40f * ramp(0.34f, 0.08f, cell.first) * ramp(0.28f, 0.46f, own));
    // Threads along the axis: pale bundles, most of them where the seeds hang and under the rind.
    const float threads = ramp(0.22f, 0.62f, thread(x, y, z));
    color = mixed(color, flesh.vein, threads * celled * (0.14f + 0.26f * band(0.52f, 0.84f, 0.10f, radius)));
    color = scaled(color, 1.0f + (1.0f - red) * (0.05f * flesh.grain(x, y, z) + 0.03f * cloud));

    const float skin_end = 0.015f + 0.003f * edge;
    if (y < 3.0f * skin_end) color = mixed(skin_at(x, z), color, ramp(0.8f * skin_end, 2.2f * skin_end, y));
    return material(color);
  }

  /// Dark stripes with torn edges on light green that is netted and flecked with the dark.
  Rgb skin_at(float x, float z) const {
    const float torn = jag(x, 0, z), blot = mottle(x, 0, z), fine = fleck(x, 0, z);
    const float place = x + 0.09f * sway(x, 0, z);
    const float across = std::fabs(place - std::floor(place) - 0.5f); // 0 in the middle of a stripe
    const float half = 0.215f + 0.05f * swell(x, 0, z);
    const float stripe = ramp(0.030f, -0.030f, across - half - 0.15f * torn - 0.05f * blot);
    // Between the stripes: a net of thin dark lines that thickens towards them.
    const ScatteredPoints::Nearest mesh = net.nearest(x + 0.02f * blot, 0.5f, z + 0.02f * torn);
    const float near_stripe = ramp(0.5f, 0.25f, across);
    const float line = 1.0f - ramp(0.02f, 0.10f + 0.10f * near_stripe, mesh.second - mesh.first);
    Rgb light = mixed(skin_light, skin_pale, ramp(-0.4f, 0.5f, blot + 0.4f * fine));
    light = mixed(light, skin_dark, (0.10f + 0.30f * near_stripe) * line * ramp(-0.5f, 0.4f, blot));
    light = mixed(light, skin_dark, 0.30f * ramp(0.15f, 0.6f, fine + 0.3f * near_stripe));
    const Rgb dark = mixed(skin_dark, skin_middle, 0.75f * ramp(0.02f, 0.55f, -blot + 0.25f * fine));
    return scaled(mixed(light, dark, stripe), 1.0f + 0.07f * fine);
  }

  Watermelon flesh;
  FractalNoise sway, jag, swell, mottle;
  ScatteredPoints net;
  FractalNoise fleck, thread;
  ScatteredPoints cells;
  FractalNoise patch;

  std::array<Stop, 12> stops{{{0.00f, measured(240, 112, 102)},
                              {0.12f, measured(236, 90, 84)},
                              {0.28f, measured(230, 66, 64)},
                              {0.55f, measured(224, 54, 54)},
                              {0.78f, measured(226, 60, 58)},
                              {0.85f, measured(232, 96, 84)},
                              {0.885f, measured(240, 170, 142)},
                              {0.915f, measured(240, 224, 190)},
                              {0.945f, measured(232, 236, 196)},
                              {0.97f, measured(204, 222, 150)},
                              {0.985f, measured(150, 186, 92)},
                              {1.00f, measured(96, 142, 54)}}};
  Rgb pale = measured(242, 118, 108), deep = measured(206, 34, 42);
  Rgb skin_dark = measured(20, 52, 22), skin_middle = measured(44, 88, 36), skin_light = measured(128, 164, 82),
      skin_pale = measured(170, 194, 118);
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

Exemplar watermelon_striped_exemplar(const ProceduralOptions& options) {
  const StripedWatermelon watermelon(options.seed);
  return painted({.name = "watermelon-striped",
                  .wrap = wrap_around,
                  .skin = true,
                  .at = [&](float x, float y, float z) { return watermelon.at(x, y, z); }},
                 options);
}

} // namespace pith
