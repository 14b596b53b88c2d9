// A zoned tourmaline, type 2-c: green rind, white seam and pink core across the depth; along the crystal the core
// turns from pink at the foot to blue at the tip. Free around (axis 0), imposed along depth (axis 1) and along (axis
// 2).
#include "volume/exemplar/paint.h"
#include "volume/exemplar/painters.h"

namespace pith {

using namespace paint;

Exemplar mineral_exemplar(const ProceduralOptions& options) {
  const std::uint64_t seed = options.seed;
  constexpr Tiling tiling{true, false, false};
  const FractalNoise cloud(hash_of(seed, 1), {3, 4, 3}, 3, tiling), flaw(hash_of(seed, 2), {5, 5, 5}, 2, tiling);
  const TileNoise zone(hash_of(seed, 3), {1, 1, 26}, tiling), shell(hash_of(seed, 4), {2, 30, 2}, tiling),
      striation(hash_of(seed, 5), {60, 1, 2}, tiling);
  const ScatteredPoints inclusions(hash_of(seed, 6), {10, 10, 10}, 0.45f, tiling);
  // Colours of the rind, the seam and the core from the foot (0) to the tip (1).
  const std::array<Stop, 4> rind{{{0.0f, measured(30, 58, 34)},
                                  {0.35f, measured(44, 112, 62)},
                                  {0.7f, measured(54, 138, 110)},
                                  {1.0f, measured(28, 84, 126)}}};
  const std::array<Stop, 5> core{{{0.0f, measured(190, 30, 92)},
                                  {0.35f, measured(232, 84, 138)},
                                  {0.60f, measured(244, 172, 186)},
                                  {0.75f, measured(168, 214, 196)},
                                  {1.0f, measured(40, 120, 170)}}};
  const Rgb seam = measured(246, 238, 230), heart = measured(150, 16, 74), skin = measured(22, 40, 30),
            bubble = measured(252, 244, 246);
  return painted(
      {.name = "mineral",
       .wrap = {Wrap::repeat, Wrap::clamp, Wrap::clamp},
       .skin = true,
       .at =
           [&](float x, float y, float z) {
             const float slow = cloud(x, y, z);
             const float along = std::clamp(z + 0.03f * slow, 0.0f, 1.0f);
             const float radius = std::clamp(radius_at_depth(y) + 0.012f * slow, 0.0f, 1.0f);
             Rgb color = color_at(core, along + 0.04f * zone(x, y, z));
             color = mixed(color, mixed(heart, color, ramp(0.25f, 0.65f, along)), 0.8f * ramp(0.38f, 0.16f, radius));
             // Growth shells: thin bands of equal depth, stronger outwards.
             color = scaled(color, 1.0f + 0.16f * shell(x, y, z) * ramp(0.2f, 0.7f, radius) + 0.07f * zone(x, y, z));
             color = mixed(color, seam, 0.85f * band(0.735f, 0.79f, 0.022f, radius));
             Rgb green = color_at(rind, along);
             green = scaled(green, 1.0f + 0.20f * shell(x, y, z) + 0.10f * slow);
             color = mixed(color, green, ramp(0.785f, 0.815f, radius));
             // Clouds, healed cracks and small inclusions.
             color = scaled(color, 1.0f + 0.12f * slow);
             color = mixed(color, seam,
                           0.35f * ramp(0.045f, 0.0f, std::fabs(flaw(x, y, z))) * ramp(0.1f, 0.4f, slow + 0.2f));
             float speck = 0;
             inclusions.near(x, y, z, [&](const Point3f& d, std::uint64_t hash) {
               if (uniform_of(hash) > 0.25f) return;
               const float size = 0.006f + 0.010f * uniform_of(hash, 1);
               speck = std::max(speck,
                                ramp(1.2f, 0.6f, std::sqrt(d[0] * d[0] + d[1] * d[1] + 0.2f * d[2] * d[2]) / size));
             });
             color = mixed(color, bubble, 0.5f * speck);
             // Outside: darker, striated along the crystal.
             const float outside = 1.0f - ramp(0.008f, 0.03f, y);
             color = mixed(color, mixed(skin, scaled(green, 0.75f), 0.55f + 0.45f * striation(x, 0, z)), outside);
             return material(color);
           }},
      options);
}

} // namespace pith
