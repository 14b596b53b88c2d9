// Flesh for fruit surfaces that come from elsewhere, type 2-b: bell pepper, banana, citrus.
#include "volume/exemplar/paint.h"
#include "volume/exemplar/painters.h"

namespace pith {

using namespace paint;

Exemplar pepper_exemplar(const ProceduralOptions& options) {
  // A glossy skin over a juicy wall; inside the wall's bumpy lining spongy pith with flat pale seeds.
  const std::uint64_t seed = options.seed;
  const FractalNoise cloud(hash_of(seed, 1), {4, 4, 4}, 3, tile_around),
      fine(hash_of(seed, 2), {40, 40, 40}, 2, tile_around), border(hash_of(seed, 3), {6, 2, 5}, 2, tile_around);
  const ScatteredPoints cells(hash_of(seed, 4), {30, 30, 30}, 0.45f, tile_around),
      seeds(hash_of(seed, 5), {6, 8, 6}, 0.42f, tile_around);
  const TileNoise vein(hash_of(seed, 6), {24, 12, 3}, tile_around);
  const std::array<Stop, 7> flesh{{{0.00f, measured(252, 236, 196)},
                                   {0.40f, measured(250, 228, 176)},
                                   {0.78f, measured(250, 218, 156)},
                                   {0.84f, measured(246, 190, 96)},
                                   {0.87f, measured(240, 148, 34)},
                                   {0.95f, measured(238, 128, 18)},
                                   {1.00f, measured(226, 96, 6)}}};
  const Rgb sparkle = measured(255, 196, 96), lining = measured(255, 214, 130), seed_color = measured(246, 224, 160),
            seed_rim = measured(206, 160, 84), skin = measured(236, 104, 10), skin_light = measured(246, 136, 30),
            hollow = measured(226, 190, 128);
  return painted({.name = "pepper",
                  .wrap = wrap_around,
                  .skin = true,
                  .at =
                      [&](float x, float y, float z) {
                        const float slow = cloud(x, y, z), edge = border(x, y, z);
                        const float radius = std::clamp(
                            radius_at_depth(y) + 0.02f * edge * ramp(1.0f, 0.85f, radius_at_depth(y)), 0.0f, 1.0f);
                        Rgb color = color_at(flesh, radius);
                        const float wall = ramp(0.855f, 0.885f, radius);
                        const ScatteredPoints::Nearest cell = cells.nearest(x, y, z);
                        const float own = uniform_of(cell.hash) - 0.5f;
                        color = scaled(color, 1.0f + 0.06f * slow + 0.12f * own * (0.4f + 0.6f * wall) -
                                                  0.12f * wall * ramp(0.2f, 0.0f, cell.second - cell.first));
                        color = mixed(color, sparkle, 0.25f * wall * ramp(0.3f, 0.5f, own));
                        color = mixed(color, lining, 0.8f * band(0.843f, 0.863f, 0.008f, radius));
                        color = mixed(color, hollow, (1.0f - wall) * 0.45f * ramp(0.2f, 0.7f, vein(x, y, z)));
                        if (radius < 0.84f) {
                          float inside = 0, rim = 0;
                          seeds.near(x, y, z, [&](const Point3f& d, std::uint64_t hash) {
                            const float r = radius_at_depth(std::clamp(y - d[1], 0.0f, 1.0f));
                            if (r > 0.74f || r < 0.25f || uniform_of(hash) < 0.35f) return;
                            const float turn = 6.2831853f * uniform_of(hash, 1);
                            const float u = d[0] * std::cos(turn) + d[2] * std::sin(turn),
                                        v = d[2] * std::cos(turn) - d[0] * std::sin(turn);
                            const float size = 0.058f * (0.5f + r);
                            const float q = std::sqrt(u * u + d[1] * d[1] * 1.4f + v * v * 9.0f) / size;
                            inside = std::max(inside, ramp(1.08f, 0.92f, q));
                            rim = std::max(rim, band(0.80f, 1.10f, 0.10f, q));
                          });
                          color = mixed(color, seed_color, inside);
                          color = mixed(color, seed_rim, 0.7f * rim);
                        }
                        if (y < 0.04f)
                          color = mixed(mixed(skin, skin_light, std::clamp(0.4f + 0.6f * cloud(x, 0, z), 0.0f, 1.0f)),
                                        color, ramp(0.010f, 0.028f, y));
                        return material(scaled(color, 1.0f + 0.03f * fine(x, y, z)));
                      }},
                 options);
}

Exemplar banana_exemplar(const ProceduralOptions& options) {
  // Peel with bundles along T, its pale lining, creamy flesh with rays, three rows of seed traces around the middle.
  const std::uint64_t seed = options.seed;
  const FractalNoise cloud(hash_of(seed, 1), {4, 4, 3}, 2, tile_around),
      fine(hash_of(seed, 2), {44, 44, 30}, 2, tile_around), spot(hash_of(seed, 3), {10, 1, 8}, 3, tile_around),
      border(hash_of(seed, 4), {6, 2, 3}, 2, tile_around);
  const TileNoise ray(hash_of(seed, 5), {26, 5, 8}, tile_around), fiber(hash_of(seed, 6), {54, 30, 4}, tile_around);
  const ScatteredPoints traces(hash_of(seed, 7), {9, 12, 14}, 0.40f, tile_around);
  const std::array<Stop, 8> flesh{{{0.00f, measured(222, 196, 142)},
                                   {0.10f, measured(232, 208, 152)},
                                   {0.24f, measured(244, 226, 176)},
                                   {0.45f, measured(250, 238, 200)},
                                   {0.80f, measured(252, 242, 208)},
                                   {0.865f, measured(246, 232, 186)},
                                   {0.885f, measured(240, 224, 162)},
                                   {1.00f, measured(240, 206, 84)}}};
  const Rgb pale = measured(255, 248, 222), gap = measured(214, 190, 128), trace = measured(96, 70, 40),
            skin = measured(244, 206, 52), skin_green = measured(214, 200, 70), brown = measured(120, 78, 34),
            bundle = measured(222, 196, 116);
  return painted(
      {.name = "banana",
       .wrap = wrap_around,
       .skin = true,
       .at =
           [&](float x, float y, float z) {
             const float slow = cloud(x, y, z);
             const float radius = std::clamp(radius_at_depth(y) + 0.010f * border(x, y, z), 0.0f, 1.0f);
             Rgb color = color_at(flesh, radius);
             const float inside = 1.0f - ramp(0.86f, 0.88f, radius);
             color = mixed(color, pale, inside * 0.5f * ramp(0.1f, 0.7f, ray(x, y, z)) * ramp(0.2f, 0.4f, radius));
             color = scaled(color, 1.0f + 0.03f * slow + 0.05f * fine(x, y, z));
             color = mixed(color, gap, 0.6f * band(0.866f, 0.880f, 0.006f, radius));
             color = mixed(color, bundle, (1 - inside) * 0.6f * ramp(0.25f, 0.7f, fiber(x, y, z)));
             float mark = 0;
             traces.near(x, y, z, [&](const Point3f& d, std::uint64_t hash) {
               const float r = radius_at_depth(std::clamp(y - d[1], 0.0f, 1.0f));
               if (r > 0.34f || r < 0.12f || uniform_of(hash) < 0.35f) return;
               const float size = 0.020f + 0.016f * uniform_of(hash, 1);
               mark = std::max(
                   mark, ramp(1.15f, 0.7f, std::sqrt(d[0] * d[0] * 1.6f + d[1] * d[1] + d[2] * d[2] * 1.6f) / size));
             });
             color = mixed(color, trace, 0.8f * mark);
             if (y < 0.05f) {
               Rgb outside = mixed(skin, skin_green, ramp(0.1f, 0.7f, cloud(x, 0, z)));
               outside = mixed(outside, brown, 0.85f * ramp(0.42f, 0.62f, spot(x, 0, z)));
               outside = scaled(outside, 1.0f + 0.04f * fiber(x, 0, z));
               color = mixed(outside, color, ramp(0.012f, 0.030f, y));
             }
             return material(color);
           }},
      options);
}

Exemplar citrus_exemplar(const ProceduralOptions& options) {
  // Oil glands in the rind, white pith, segments between membranes, each full of juice sacs that point inwards.
  const std::uint64_t seed = options.seed;
  const FractalNoise cloud(hash_of(seed, 1), {4, 3, 4}, 2, tile_around),
      fine(hash_of(seed, 2), {50, 50, 50}, 2, tile_around), border(hash_of(seed, 3), {5, 2, 4}, 2, tile_around);
  const TileNoise warp(hash_of(seed, 4), {3, 3, 2}, tile_around);
  const ScatteredPoints sacs(hash_of(seed, 5), {17, 6, 17}, 0.45f, tile_around),
      glands(hash_of(seed, 6), {24, 24, 24}, 0.42f, tile_around);
  const std::array<Stop, 7> flesh{{{0.00f, measured(252, 244, 222)},
                                   {0.12f, measured(252, 236, 196)},
                                   {0.20f, measured(248, 178, 66)},
                                   {0.82f, measured(246, 156, 30)},
                                   {0.855f, measured(252, 226, 172)},
                                   {0.94f, measured(254, 240, 206)},
                                   {1.00f, measured(242, 146, 22)}}};
  const Rgb membrane = measured(253, 230, 178), bright = measured(255, 206, 104), deep = measured(226, 112, 8),
            skin = measured(240, 134, 14), skin_dark = measured(214, 100, 6), oil = measured(250, 176, 50);
  return painted(
      {.name = "citrus",
       .wrap = wrap_around,
       .skin = true,
       .at =
           [&](float x, float y, float z) {
             const float slow = cloud(x, y, z);
             const float radius = std::clamp(radius_at_depth(y) + 0.010f * border(x, y, z), 0.0f, 1.0f);
             Rgb color = color_at(flesh, radius);
             const float pulp = ramp(0.15f, 0.22f, radius) * (1.0f - ramp(0.82f, 0.845f, radius));
             // Juice sacs: long cells along S, each with its own brightness.
             const ScatteredPoints::Nearest sac = sacs.nearest(x, y, z);
             const float own = uniform_of(sac.hash), rim = ramp(0.22f, 0.0f, sac.second - sac.first);
             Rgb juice = scaled(mixed(deep, color, 0.55f + 0.45f * own), 0.94f + 0.16f * own);
             juice = mixed(juice, bright, 0.55f * rim + 0.2f * ramp(0.4f, 0.1f, sac.first) * own);
             color = mixed(color, juice, pulp);
             // Membranes between the segments: about two a texture width where the pulp ends.
             const float place = 2.0f * (x + 0.03f * warp(x, y, z)) + 0.3f;
             const float across = std::fabs(place - std::floor(place) - 0.5f);
             const float thickness = 0.026f + 0.040f * ramp(0.7f, 0.84f, radius) + 0.020f * ramp(0.4f, 0.2f, radius);
             color = mixed(color, membrane, pulp * ramp(0.5f - 1.8f * thickness, 0.5f - 0.6f * thickness, across));
             color = scaled(color, 1.0f + 0.03f * slow + 0.03f * fine(x, y, z));
             // Rind.
             if (y < 0.12f) {
               float gland = 0;
               glands.near(x, y, z, [&](const Point3f& d, std::uint64_t hash) {
                 const float size = 0.011f + 0.007f * uniform_of(hash);
                 gland = std::max(gland, ramp(1.2f, 0.6f, std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / size));
               });
               Rgb rind = mixed(skin, skin_dark, 0.55f * gland);
               rind = mixed(rind, oil, 0.4f * gland * ramp(0.01f, 0.03f, y));
               rind = scaled(rind, 1.0f + 0.06f * cloud(x, 0, z) + 0.04f * fine(x, y, z));
               color = mixed(rind, color, ramp(0.035f, 0.060f, y + 0.008f * slow));
             }
             return material(color);
           }},
      options);
}

} // namespace pith
