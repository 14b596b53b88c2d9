// A peach that ripens from one side, type 2-d: all three axes are coordinates of the fruit. x: 0 on the side in the
// shade, 1 on the side in the sun; y: depth, with the stone in the middle; z: 0 at the stem, 1 at the other end.
#include "volume/exemplar/paint.h"
#include "volume/exemplar/painters.h"

namespace pith {

using namespace paint;

Exemplar ripening_exemplar(const ProceduralOptions& options) {
  const std::uint64_t seed = options.seed;
  constexpr Tiling tiling{false, false, false};
  const FractalNoise cloud(hash_of(seed, 1), {4, 4, 4}, 3, tiling), mottle(hash_of(seed, 2), {12, 2, 12}, 3, tiling),
      grain(hash_of(seed, 3), {40, 40, 40}, 2, tiling);
  const TileNoise fiber(hash_of(seed, 4), {46, 4, 46}, tiling), furrow(hash_of(seed, 5), {14, 3, 14}, tiling),
      fuzz(hash_of(seed, 6), {100, 1, 100}, tiling);
  const std::array<Stop, 4> ripe{{{0.00f, measured(196, 208, 118)},
                                  {0.35f, measured(240, 214, 110)},
                                  {0.65f, measured(250, 188, 84)},
                                  {1.00f, measured(248, 156, 66)}}};
  const std::array<Stop, 5> skin{{{0.00f, measured(166, 188, 84)},
                                  {0.30f, measured(226, 204, 96)},
                                  {0.55f, measured(242, 166, 84)},
                                  {0.75f, measured(220, 84, 58)},
                                  {1.00f, measured(158, 28, 42)}}};
  const Rgb stain = measured(196, 34, 52), stone = measured(142, 92, 56), stone_dark = measured(84, 48, 28),
            kernel = measured(238, 220, 186), seam = measured(250, 224, 160);
  return painted({.name = "ripening",
                  .wrap = {Wrap::clamp, Wrap::clamp, Wrap::clamp},
                  .skin = true,
                  .at =
                      [&](float x, float y, float z) {
                        const float slow = cloud(x, y, z), radius = radius_at_depth(y);
                        // How ripe it is here: the sunny side first, the stem's end last.
                        const float state = std::clamp(x + 0.10f * slow + 0.18f * (z - 0.5f), 0.0f, 1.0f);
                        Rgb color = color_at(ripe, state);
                        color = scaled(color, 1.0f + 0.06f * slow + 0.06f * grain(x, y, z));
                        const float threads = ramp(0.1f, 0.8f, fiber(x, y, z));
                        color = mixed(color, seam, 0.30f * threads * band(0.45f, 0.9f, 0.08f, radius));
                        // Red around the stone where it is ripe, running outwards along the fibres.
                        const float reach = 0.52f + 0.16f * threads + 0.05f * slow;
                        color = mixed(color, stain, (0.25f + 0.70f * state) * ramp(reach, 0.38f, radius));
                        color = mixed(color, color_at(skin, state), 0.5f * ramp(0.93f, 1.0f, radius));
                        // The stone: hard, furrowed, with a kernel.
                        const float border = 0.385f + 0.018f * furrow(x, y, z);
                        const float in_stone = ramp(border + 0.012f, border - 0.012f, radius);
                        Rgb hard =
                            mixed(stone_dark, stone,
                                  std::clamp(0.55f + 0.5f * furrow(z, y, x) + 0.3f * grain(x, y, z), 0.0f, 1.0f));
                        hard = mixed(hard, stone_dark, ramp(border - 0.06f, border - 0.01f, radius));
                        hard = mixed(hard, kernel, ramp(0.20f, 0.16f, radius));
                        color = mixed(color, hard, in_stone);
                        // Skin: blush in fine dots, under fuzz.
                        if (y < 0.05f) {
                          const float blush =
                              std::clamp(state + 0.13f * mottle(x, 0, z) + 0.05f * fuzz(x, 0, z), 0.0f, 1.0f);
                          Rgb outside = scaled(color_at(skin, blush), 1.0f + 0.08f * fuzz(x, 0, z));
                          color = mixed(outside, color, ramp(0.010f, 0.030f, y));
                        }
                        return material(color);
                      }},
                 options);
}

} // namespace pith
