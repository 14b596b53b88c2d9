// Brickwork, type 2-a: stretchers in running bond, lengths along R, courses along S, two wythes along T. For
// structured textures; the height tells how far the mortar lies back.
#include "volume/exemplar/paint.h"
#include "volume/exemplar/painters.h"

namespace pith {

using namespace paint;

Exemplar brick_exemplar(const ProceduralOptions& options) {
  const std::uint64_t seed = options.seed;
  constexpr int bricks = 2, courses = 6, wythes = 4; // in a texture width: lengths 3, heights 1, depths 1.5
  constexpr float joint = 0.016f, round = 0.010f;
  const FractalNoise rough(hash_of(seed, 1), {14, 14, 14}, 3), cloud(hash_of(seed, 2), {5, 5, 5}, 2),
      wave(hash_of(seed, 3), {6, 6, 6}, 2), sand(hash_of(seed, 4), {40, 40, 40}, 2);
  const ScatteredPoints pores(hash_of(seed, 5), {22, 22, 22}, 0.45f);
  const std::array<Rgb, 5> clay{measured(166, 74, 52), measured(182, 92, 62), measured(146, 60, 46),
                                measured(194, 110, 76), measured(128, 56, 48)};
  const Rgb mortar = measured(196, 188, 174), mortar_dark = measured(158, 148, 134), burnt = measured(84, 40, 36),
            pore = measured(96, 44, 34);
  return painted(
      {.name = "brick",
       .channel = {Channel{}, height_channel(-4, 1)},
       .at =
           [&](float x, float y, float z) {
             const float bent = 0.0035f * wave(x, y, z);
             const float course_at = (y + bent) * courses, course = std::floor(course_at);
             const float wythe_at = (z + bent) * wythes, wythe = std::floor(wythe_at);
             const auto modulo = [](float value, int n) { return ((int(value) % n) + n) % n; };
             const int row = modulo(course, courses), layer = modulo(wythe, wythes);
             const float brick_at = (x + bent) * bricks + 0.5f * float((row + layer) % 2),
                         brick = std::floor(brick_at);
             const int column = modulo(brick, bricks);
             const std::uint64_t own = hash_of(seed, 6, column, row, layer);
             // Distance to the brick's surface, texture widths, negative inside; corners are rounded.
             const float size[3] = {1.0f / bricks, 1.0f / courses, 1.0f / wythes};
             const float local[3] = {brick_at - brick - 0.5f, course_at - course - 0.5f, wythe_at - wythe - 0.5f};
             float outside = 0, inner = -1e9f;
             for (int a = 0; a < 3; ++a) {
               const float q = std::fabs(local[a]) * size[a] - (0.5f * size[a] - 0.5f * joint - round);
               outside += std::max(q, 0.0f) * std::max(q, 0.0f);
               inner = std::max(inner, q);
             }
             const float distance = std::sqrt(outside) + std::min(inner, 0.0f) - round + 0.004f * rough(x, y, z);
             const float is_brick = ramp(0.004f, -0.004f, distance);

             Rgb fired = mixed(clay[std::size_t(uniform_of(own) * 4.999f)],
                               clay[std::size_t(uniform_of(own, 1) * 4.999f)], 0.4f);
             fired =
                 scaled(fired, 0.85f + 0.3f * uniform_of(own, 2) + 0.16f * rough(x, y, z) + 0.12f * cloud(x, y, z));
             fired =
                 mixed(fired, burnt, 0.35f * ramp(-0.02f, 0.0f, distance) + 0.3f * ramp(0.35f, 0.8f, cloud(y, z, x)));
             float hole = 0;
             pores.near(x, y, z, [&](const Point3f& d, std::uint64_t hash) {
               if (uniform_of(hash) > 0.35f) return;
               const float radius = 0.004f + 0.008f * uniform_of(hash, 1);
               hole = std::max(hole, ramp(1.2f, 0.7f, std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / radius));
             });
             fired = mixed(fired, pore, 0.7f * hole);
             const Rgb bed = scaled(mixed(mortar_dark, mortar, std::clamp(0.5f + 0.6f * sand(x, y, z), 0.0f, 1.0f)),
                                    1.0f + 0.10f * rough(x, y, z));
             Material m = material(mixed(bed, fired, is_brick));
             m[3] = -3.0f * (1.0f - is_brick) + 0.4f * rough(x, y, z) - 0.8f * hole * is_brick;
             return m;
           }},
      options);
}

} // namespace pith
