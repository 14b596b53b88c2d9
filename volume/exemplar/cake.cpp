// Cake, type 0: sponge with pores of many sizes and a torn crumb, whipped cream, chocolate. Alike in all directions.
#include "volume/exemplar/paint.h"
#include "volume/exemplar/painters.h"

namespace pith {

using namespace paint;

Exemplar sponge_exemplar(const ProceduralOptions& options) {
  const std::uint64_t seed = options.seed;
  const FractalNoise cloud(hash_of(seed, 1), {3, 3, 3}, 2), crumb(hash_of(seed, 2), {14, 14, 14}, 3),
      warp(hash_of(seed, 3), {8, 8, 8}, 2);
  const ScatteredPoints large(hash_of(seed, 4), {5, 5, 5}, 0.45f), middle(hash_of(seed, 5), {11, 11, 11}, 0.45f),
      small(hash_of(seed, 6), {24, 24, 24}, 0.45f);
  const Rgb pale = measured(250, 226, 156), golden = measured(234, 194, 104), wall = measured(252, 236, 184),
            hole = measured(158, 110, 44), deep = measured(112, 70, 26);
  return painted(
      {.name = "sponge",
       .at =
           [&](float x, float y, float z) {
             // Pores are drawn in a space that noise has bent, so that none is a ball.
             const float a = 0.020f * warp(x, y, z), b = 0.020f * warp(y, z, x), c = 0.020f * warp(z, x, y);
             float pore = 0, rim = 0, shade = 0;
             const auto pores = [&](const ScatteredPoints& points, float least, float most, float share) {
               points.near(x + a, y + b, z + c, [&](const Point3f& d, std::uint64_t hash) {
                 if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] > 4.0f * most * most)
                   return; // beyond the rim of the largest
                 if (uniform_of(hash) > share) return;
                 const float u = uniform_of(hash, 1), radius = least + (most - least) * u * u;
                 const float squeeze = 0.7f + 0.6f * uniform_of(hash, 2);
                 const float q = std::sqrt(d[0] * d[0] * squeeze + d[1] * d[1] + d[2] * d[2] / squeeze) / radius;
                 pore = std::max(pore, ramp(1.12f, 0.82f, q));
                 rim = std::max(rim, ramp(1.6f, 1.1f, q));
                 shade = std::max(shade, ramp(1.0f, 0.1f, q));
               });
             };
             pores(large, 0.020f, 0.075f, 0.55f);
             pores(middle, 0.012f, 0.034f, 0.75f);
             pores(small, 0.007f, 0.016f, 0.70f);
             const float rough = crumb(x, y, z);
             Rgb color = mixed(golden, pale, std::clamp(0.55f + 0.5f * rough + 0.25f * cloud(x, y, z), 0.0f, 1.0f));
             color = mixed(color, wall, 0.5f * rim * (1 - pore));
             color = mixed(color, mixed(hole, deep, shade), 0.80f * pore * (0.75f + 0.25f * rough));
             return material(scaled(color, 1.0f + 0.10f * rough));
           }},
      options);
}

Exemplar cream_exemplar(const ProceduralOptions& options) {
  const std::uint64_t seed = options.seed;
  const FractalNoise slow(hash_of(seed, 1), {3, 3, 3}, 3), fine(hash_of(seed, 2), {26, 26, 26}, 2);
  const ScatteredPoints bubbles(hash_of(seed, 3), {16, 16, 16}, 0.45f);
  const Rgb cream = measured(252, 248, 236), shade = measured(240, 230, 206), hole = measured(222, 206, 172);
  return painted({.name = "cream",
                  .at =
                      [&](float x, float y, float z) {
                        Rgb color = mixed(cream, shade, std::clamp(0.35f + 0.5f * slow(x, y, z), 0.0f, 1.0f));
                        color = scaled(color, 1.0f + 0.025f * fine(x, y, z));
                        float bubble = 0;
                        bubbles.near(x, y, z, [&](const Point3f& d, std::uint64_t hash) {
                          if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] > 0.0005f) return;
                          if (uniform_of(hash) < 0.8f) return;
                          const float radius = 0.007f + 0.010f * uniform_of(hash, 1);
                          const float q = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / radius;
                          bubble = std::max(bubble, ramp(1.2f, 0.6f, q));
                        });
                        return material(mixed(color, hole, 0.6f * bubble));
                      }},
                 options);
}

Exemplar chocolate_exemplar(const ProceduralOptions& options) {
  const std::uint64_t seed = options.seed;
  const FractalNoise slow(hash_of(seed, 1), {3, 3, 3}, 3), fine(hash_of(seed, 2), {28, 28, 28}, 2);
  const ScatteredPoints grains(hash_of(seed, 3), {13, 13, 13}, 0.45f);
  const Rgb dark = measured(52, 27, 16), light = measured(88, 50, 30), grain = measured(122, 78, 50);
  return painted({.name = "chocolate",
                  .at =
                      [&](float x, float y, float z) {
                        Rgb color = mixed(dark, light, std::clamp(0.45f + 0.55f * slow(x, y, z), 0.0f, 1.0f));
                        color = scaled(color, 1.0f + 0.10f * fine(x, y, z));
                        float speck = 0;
                        grains.near(x, y, z, [&](const Point3f& d, std::uint64_t hash) {
                          if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] > 0.0006f) return;
                          if (uniform_of(hash) < 0.82f) return;
                          const float radius = 0.008f + 0.012f * uniform_of(hash, 1);
                          const float q = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / radius;
                          speck = std::max(speck, ramp(1.2f, 0.7f, q));
                        });
                        return material(mixed(color, grain, 0.55f * speck));
                      }},
                 options);
}

} // namespace pith
