// A trunk, type 2-b, after a photographed disc of loblolly pine (UruDendro): bark with furrows along T outside, rings
// that are wide near the pith and narrow outside, pale early wood that darkens to late wood and ends sharply, rays,
// pith. Beside colour there is the height of the bark, for displacement.
#include "volume/exemplar/paint.h"
#include "volume/exemplar/painters.h"

namespace pith {

using namespace paint;

namespace {

constexpr float wood_end = 0.935f; ///< the part of the radius where the bark begins

struct Tree {
  explicit Tree(std::uint64_t seed)
      : cloud(hash_of(seed, 1), {4, 4, 3}, 2, tile_around), fiber(hash_of(seed, 2), {52, 56, 4}, 2, tile_around),
        stray(hash_of(seed, 3), {5, 4, 2}, 2, tile_around), ray(hash_of(seed, 4), {84, 5, 22}, tile_around),
        resin(hash_of(seed, 5), {60, 60, 6}, tile_around), plate(hash_of(seed, 6), {6, 1, 2}, 0.45f, tile_around),
        plate_warp(hash_of(seed, 7), {7, 1, 5}, 3, tile_around), flake(hash_of(seed, 8), {18, 10, 9}, 3, tile_around),
        layer(hash_of(seed, 9), {5, 14, 4}, tile_around) {
    // Ring borders, from the pith outwards. The first are wide; each varies on its own, as good and bad years do.
    float at = 0.0f;
    for (int i = 0; at < wood_end; ++i) {
      border.push_back(at);
      darkness.push_back(0.65f + 0.35f * uniform_of(hash_of(seed, 10, i)));
      const float mean = 0.030f + 0.055f * (1.0f - ramp(0.05f, 0.55f, at));
      at += mean * (0.70f + 0.60f * uniform_of(hash_of(seed, 11, i)));
    }
    border.push_back(wood_end + 0.01f);
  }

  Material at(float x, float y, float z) const {
    const float slow = cloud(x, y, z), fibers = fiber(x, y, z);
    const float radius = radius_at_depth(y);
    const float shifted = std::clamp(radius + 0.010f * stray(x, y, z) * ramp(0.0f, 0.2f, radius), 0.0f, 1.0f);

    // Wood.
    const auto next = std::upper_bound(border.begin(), border.end() - 1, shifted);
    const std::size_t ring = std::size_t(std::max<std::ptrdiff_t>(0, next - border.begin() - 1));
    const float width = border[ring + 1] - border[ring];
    const float t = std::clamp((shifted - border[ring]) / width, 0.0f, 1.0f); // 0 early … 1 late wood
    const float heart = 1.0f - ramp(0.34f, 0.44f, shifted + 0.02f * slow);
    const float texel = 0.5f * (1.0f / 128.0f) / std::max(radius, 0.06f); // a texel of depth, in radius
    const float sharp = std::min(0.5f, 1.5f * texel / width);
    float late = ramp(0.30f, 0.92f, t) * ramp(0.0f, sharp, 1.0f - t);
    late *= darkness[ring];
    Rgb color = mixed(mixed(early, early_heart, heart), mixed(late_wood, late_heart, heart), late);
    color = mixed(color, ray_color, 0.28f * ramp(0.25f, 0.8f, ray(x, y, z)) * (1.0f - 0.5f * late));
    color = mixed(color, late_wood, 0.35f * ramp(0.55f, 0.9f, resin(x, y, z)) * ramp(0.2f, 0.5f, t));
    color = scaled(color, 1.0f + 0.05f * slow + 0.11f * fibers);
    // Pith.
    color = mixed(pith_color, color, ramp(0.050f, 0.085f, radius));

    // Cambium and inner bark, then the outer bark's plates with furrows between them.
    const Bark outer = bark(x, z);
    const float depth_of_furrow = 0.075f * outer.furrow; // in depth
    const float bast = ramp(wood_end - 0.006f, wood_end + 0.004f, radius + 0.004f * plate_warp(x, 0, z));
    if (bast > 0) {
      const float layers = layer(x, y + 0.03f * plate_warp(x, 0, z), z);
      Rgb inner = mixed(bast_color, bark_red, ramp(wood_end + 0.004f, wood_end + 0.02f, radius));
      Rgb rough =
          mixed(bark_dark, bark_light, std::clamp(0.45f + 0.55f * flake(x, y, z) + 0.25f * layers, 0.0f, 1.0f));
      rough = mixed(rough, bark_red, 0.5f * ramp(0.15f, 0.5f, layers) * ramp(0.01f, 0.05f, y));
      rough = mixed(rough, bark_gray,
                    (1.0f - ramp(0.004f, 0.03f, y)) * (0.35f + 0.35f * flake(x, 0, z)) * (1 - outer.furrow));
      Rgb shell = mixed(inner, rough, ramp(wood_end + 0.010f, wood_end + 0.028f, radius));
      // Down in a furrow it is dark, up to the furrow's floor.
      const float open = outer.furrow * ramp(1.1f, 0.5f, y / std::max(depth_of_furrow, 1e-3f));
      shell = mixed(shell, furrow_color, std::clamp(0.92f * open, 0.0f, 1.0f));
      color = mixed(color, shell, bast);
    }
    Material m = material(color);
    m[3] = outer.height * (1.0f - ramp(0.05f, 0.13f, y));
    return m;
  }

private:
  struct Bark {
    float furrow; ///< 0 on a plate … 1 in the middle of a furrow
    float height; ///< mm
  };
  Bark bark(float x, float z) const {
    const float wx = x + 0.055f * plate_warp(x, 0, z), wz = z + 0.05f * plate_warp(z, 0, x);
    const ScatteredPoints::Nearest n = plate.nearest(wx, 0.5f, wz);
    const float gap = n.second - n.first; // 0 between plates
    const float furrow = 1.0f - ramp(0.05f, 0.30f, gap + 0.06f * flake(x, 0, z));
    const float dome = ramp(0.1f, 0.7f, gap);
    return {furrow, -3.0f * furrow + 1.0f * dome + 0.5f * flake(x, 0, z) * (1.0f - furrow)};
  }

  FractalNoise cloud, fiber, stray;
  TileNoise ray, resin;
  ScatteredPoints plate;
  FractalNoise plate_warp, flake;
  TileNoise layer;
  std::vector<float> border, darkness;

  Rgb early = measured(228, 204, 168), early_heart = measured(214, 176, 134), late_wood = measured(168, 112, 70),
      late_heart = measured(142, 86, 54), ray_color = measured(238, 214, 178), pith_color = measured(150, 98, 62);
  Rgb bast_color = measured(196, 150, 96), bark_red = measured(128, 74, 48), bark_dark = measured(70, 50, 40),
      bark_light = measured(132, 102, 82), bark_gray = measured(146, 132, 118), furrow_color = measured(34, 25, 21);
};

} // namespace

Exemplar tree_exemplar(const ProceduralOptions& options) {
  const Tree tree(options.seed);
  return painted({.name = "tree",
                  .wrap = wrap_around,
                  .channel = {Channel{}, height_channel(-4, 2)},
                  .skin = true,
                  .at = [&](float x, float y, float z) { return tree.at(x, y, z); }},
                 options);
}

} // namespace pith
