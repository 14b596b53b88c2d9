// Rocks of a section through strata. Sandstone and shale are layered: type 2-a with the layers across S. Limestone
// with fossils and conglomerate with pebbles are alike in all directions: type 0.
#include "volume/exemplar/paint.h"
#include "volume/exemplar/painters.h"

namespace pith {

using namespace paint;

Exemplar sandstone_exemplar(const ProceduralOptions& options) {
  const std::uint64_t seed = options.seed;
  const FractalNoise bend(hash_of(seed, 1), {2, 2, 2}, 3), patch(hash_of(seed, 2), {3, 4, 3}, 2);
  const TileNoise thick(hash_of(seed, 3), {1, 9, 1}), thin(hash_of(seed, 4), {2, 30, 2}),
      lamina(hash_of(seed, 5), {3, 60, 3});
  const ScatteredPoints grains(hash_of(seed, 6), {44, 44, 44}, 0.45f);
  const std::array<Stop, 5> bands{{{-0.8f, measured(150, 78, 48)},
                                   {-0.3f, measured(190, 112, 68)},
                                   {0.1f, measured(214, 154, 102)},
                                   {0.45f, measured(228, 186, 136)},
                                   {0.9f, measured(242, 218, 178)}}};
  return painted({.name = "sandstone",
                  .at =
                      [&](float x, float y, float z) {
                        // Cross-bedding: the fine laminae of every other bed lean along x.
                        const float shift = y + 0.030f * bend(x, y, z);
                        const float fine = thin(x, shift + 0.5f * 0.03f * std::sin(6.2831853f * x), z);
                        const float place = 0.95f * thick(x, shift, z) + 0.38f * fine + 0.22f * lamina(x, shift, z);
                        Rgb color = color_at(bands, place);
                        const ScatteredPoints::Nearest grain = grains.nearest(x, y, z);
                        const float own = uniform_of(grain.hash) - 0.5f;
                        color =
                            scaled(color, 1.0f + 0.36f * own - 0.16f * ramp(0.25f, 0.0f, grain.second - grain.first) +
                                              0.08f * patch(x, y, z));
                        return material(color);
                      }},
                 options);
}

Exemplar shale_exemplar(const ProceduralOptions& options) {
  const std::uint64_t seed = options.seed;
  const FractalNoise bend(hash_of(seed, 1), {2, 2, 2}, 2), rough(hash_of(seed, 2), {20, 60, 20}, 2);
  const TileNoise bed(hash_of(seed, 3), {2, 12, 2}), leaf(hash_of(seed, 4), {5, 44, 5}),
      split(hash_of(seed, 5), {6, 64, 6});
  const Rgb dark = measured(48, 50, 56), middle = measured(84, 86, 92), light = measured(124, 122, 118),
            crack = measured(24, 24, 28);
  return painted({.name = "shale",
                  .at =
                      [&](float x, float y, float z) {
                        const float shift = y + 0.012f * bend(x, y, z);
                        const float place = 0.5f * bed(x, shift, z) + 0.5f * leaf(x, shift, z);
                        Rgb color = place < 0 ? mixed(middle, dark, -place * 1.3f > 1 ? 1.0f : -place * 1.3f)
                                              : mixed(middle, light, std::min(1.0f, place * 1.3f));
                        color = mixed(color, crack, 0.7f * ramp(0.45f, 0.8f, split(x, shift, z)));
                        return material(scaled(color, 1.0f + 0.14f * rough(x, y, z)));
                      }},
                 options);
}

namespace {

/// Where a point lies in rounded stones scattered at random: 0 outside … 1 inside, with the stone's own hash.
struct Stones {
  float inside = 0, depth = 0;
  std::uint64_t hash = 0;
};

/// Ellipsoids turned at random around y, of radii `least` to `most`; the one that the point is deepest in wins.
Stones stones_at(const ScatteredPoints& points, float x, float y, float z, float least, float most, float share,
                 float flat) {
  Stones result;
  float best = 1.08f;
  points.near(x, y, z, [&](const Point3f& d, std::uint64_t hash) {
    if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] > 3.4f * most * most) return; // beyond the largest stone
    if (uniform_of(hash) > share) return;
    const float radius = least + (most - least) * uniform_of(hash, 1) * uniform_of(hash, 2);
    const float turn = 6.2831853f * uniform_of(hash, 3), long_axis = 1.0f + 0.5f * uniform_of(hash, 4);
    const float u = (d[0] * std::cos(turn) + d[2] * std::sin(turn)) / long_axis,
                v = d[2] * std::cos(turn) - d[0] * std::sin(turn), w = d[1] / flat;
    const float power = 2.6f;
    const float q =
        std::pow(std::pow(std::fabs(u), power) + std::pow(std::fabs(v), power) + std::pow(std::fabs(w), power),
                 1.0f / power) /
        radius;
    if (q < best) best = q, result = {ramp(1.06f, 0.94f, q), 1.0f - std::min(q, 1.0f), hash};
  });
  return result;
}

} // namespace

Exemplar limestone_exemplar(const ProceduralOptions& options) {
  const std::uint64_t seed = options.seed;
  const FractalNoise cloud(hash_of(seed, 1), {3, 3, 3}, 3), rough(hash_of(seed, 2), {24, 24, 24}, 3),
      warp(hash_of(seed, 3), {9, 9, 9}, 2);
  const ScatteredPoints pebbles(hash_of(seed, 4), {4, 4, 4}, 0.40f), fossils(hash_of(seed, 5), {7, 7, 7}, 0.42f);
  const Rgb pale = measured(226, 220, 202), gray = measured(188, 182, 166), pebble = measured(150, 142, 128),
            pebble_warm = measured(178, 154, 118), shell = measured(244, 240, 228), vein = measured(140, 132, 116);
  return painted({.name = "limestone",
                  .at =
                      [&](float x, float y, float z) {
                        const float bent = 0.012f * warp(x, y, z);
                        Rgb color = mixed(gray, pale, std::clamp(0.55f + 0.55f * cloud(x, y, z), 0.0f, 1.0f));
                        color = scaled(color, 1.0f + 0.13f * rough(x, y, z));
                        const Stones stone =
                            stones_at(pebbles, x + bent, y - bent, z + bent, 0.045f, 0.125f, 0.75f, 0.75f);
                        if (stone.inside > 0) {
                          Rgb own = mixed(pebble, pebble_warm, uniform_of(stone.hash, 7));
                          own = scaled(own, 0.85f + 0.35f * uniform_of(stone.hash, 8) + 0.10f * rough(y, z, x));
                          own = mixed(own, vein, 0.5f * ramp(0.10f, 0.0f, stone.depth));
                          color = mixed(color, own, stone.inside);
                        } else {
                          // Shells: thin curved sheets, white with a dark line.
                          float sheet = 0, line = 0;
                          fossils.near(x, y, z, [&](const Point3f& d, std::uint64_t hash) {
                            if (uniform_of(hash) > 0.35f) return;
                            const float size = 0.030f + 0.030f * uniform_of(hash, 1),
                                        turn = 6.2831853f * uniform_of(hash, 2);
                            const float u = (d[0] * std::cos(turn) + d[1] * std::sin(turn)) / size,
                                        v = (d[1] * std::cos(turn) - d[0] * std::sin(turn)) / size, w = d[2] / size;
                            const float from_center = std::sqrt(u * u + w * w + (v + 0.6f) * (v + 0.6f));
                            if (v < -0.1f || from_center > 1.3f) return;
                            sheet = std::max(sheet, band(0.86f, 1.04f, 0.07f, from_center));
                            line = std::max(line, band(1.04f, 1.12f, 0.06f, from_center));
                          });
                          color = mixed(color, vein, 0.45f * line);
                          color = mixed(color, shell, 0.8f * sheet);
                        }
                        return material(color);
                      }},
                 options);
}

Exemplar conglomerate_exemplar(const ProceduralOptions& options) {
  const std::uint64_t seed = options.seed;
  const FractalNoise cloud(hash_of(seed, 1), {4, 4, 4}, 2), rough(hash_of(seed, 2), {26, 26, 26}, 3),
      warp(hash_of(seed, 3), {8, 8, 8}, 2);
  const ScatteredPoints large(hash_of(seed, 4), {5, 5, 5}, 0.40f), small(hash_of(seed, 5), {12, 12, 12}, 0.42f);
  const Rgb matrix = measured(128, 98, 72), matrix_dark = measured(92, 70, 54), rim = measured(70, 56, 46);
  const std::array<Rgb, 6> colors{measured(176, 168, 156), measured(206, 192, 168), measured(120, 112, 108),
                                  measured(166, 104, 76),  measured(88, 92, 98),    measured(224, 214, 200)};
  return painted({.name = "conglomerate",
                  .at =
                      [&](float x, float y, float z) {
                        const float bent = 0.010f * warp(x, y, z);
                        Rgb color = mixed(matrix_dark, matrix, std::clamp(0.5f + 0.6f * cloud(x, y, z), 0.0f, 1.0f));
                        color = scaled(color, 1.0f + 0.22f * rough(x, y, z));
                        Stones stone = stones_at(large, x + bent, y - bent, z + bent, 0.085f, 0.155f, 0.95f, 0.8f);
                        if (stone.inside <= 0)
                          stone = stones_at(small, x + bent, y - bent, z + bent, 0.022f, 0.060f, 0.85f, 0.85f);
                        if (stone.inside > 0) {
                          Rgb own = colors[std::size_t(uniform_of(stone.hash, 7) * 5.999f)];
                          own = scaled(own, 0.85f + 0.3f * uniform_of(stone.hash, 8) + 0.12f * rough(y, z, x));
                          own = mixed(own, rim, 0.45f * ramp(0.14f, 0.0f, stone.depth));
                          color = mixed(color, own, stone.inside);
                        }
                        return material(color);
                      }},
                 options);
}

} // namespace pith
