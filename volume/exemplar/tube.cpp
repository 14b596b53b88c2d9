// A bundle of translucent fibres along T, type 2-a. Beside colour: the extinction (1/mm), high in the sheaths and low
// in the fibres, and the direction of the fibres in texture space.
#include "volume/exemplar/paint.h"
#include "volume/exemplar/painters.h"

namespace pith {

using namespace paint;

Exemplar tube_exemplar(const ProceduralOptions& options) {
  const std::uint64_t seed = options.seed;
  const TileNoise sway_x(hash_of(seed, 1), {2, 2, 2}), sway_y(hash_of(seed, 2), {2, 2, 2});
  const FractalNoise cloud(hash_of(seed, 3), {3, 3, 3}, 2);
  const TileNoise streak(hash_of(seed, 4), {56, 56, 5}), thread(hash_of(seed, 5), {90, 90, 8});
  // Cells that are as long as the cube along z: their borders do not depend on z but for the sway.
  const ScatteredPoints bundle(hash_of(seed, 6), {6, 6, 1}, 0.40f), fibers(hash_of(seed, 7), {20, 20, 1}, 0.42f);
  const Rgb sheath = measured(250, 232, 206), core = measured(224, 132, 112), light = measured(246, 186, 160),
            dark = measured(168, 74, 70), vessel = measured(120, 40, 48);
  constexpr float amplitude = 0.030f;
  return painted(
      {.name = "tube",
       .channel = {Channel{}, extinction_channel(4.0f), fiber_channel()},
       .at =
           [&](float x, float y, float z) {
             const float u = x + amplitude * sway_x(x, y, z), v = y + amplitude * sway_y(x, y, z);
             // The plane of the points: distances along z do not count, so read at the middle of their only cell.
             struct Cell {
               float first = 1e9f, second = 1e9f;
               std::uint64_t hash = 0;
             };
             const auto cell_of = [&](const ScatteredPoints& points, float cells) {
               Cell c;
               points.near(u, v, 0.5f, [&](const Point3f& d, std::uint64_t hash) {
                 const float distance = std::hypot(d[0], d[1]) * cells;
                 if (hash == c.hash) return; // the same point again, a period along z away
                 if (distance < c.first)
                   c.second = c.first, c.first = distance, c.hash = hash;
                 else if (distance < c.second)
                   c.second = distance;
               });
               return c;
             };
             const Cell coarse = cell_of(bundle, 6), fine = cell_of(fibers, 20);
             const float wall = 1.0f - ramp(0.04f, 0.20f, coarse.second - coarse.first);
             const float seam = 1.0f - ramp(0.05f, 0.34f, fine.second - fine.first);
             const float own = uniform_of(fine.hash), bundle_own = uniform_of(coarse.hash);
             Rgb color = mixed(core, light, std::clamp(0.15f + 0.75f * own, 0.0f, 1.0f));
             color = mixed(color, dark, 0.45f * seam + 0.35f * ramp(0.6f, 1.0f, bundle_own));
             const bool is_vessel = uniform_of(coarse.hash, 3) < 0.25f;
             const float inside = is_vessel ? ramp(0.34f, 0.22f, coarse.first) : 0.0f;
             color = mixed(color, vessel, 0.85f * inside);
             color = mixed(color, sheath, 0.80f * wall);
             color = scaled(color, 1.0f + 0.16f * streak(u, v, z) + 0.10f * thread(u, v, z) + 0.08f * cloud(x, y, z));

             Material m = material(color);
             m[3] = 0.25f + 0.35f * own + 0.6f * seam + 2.4f * wall + 0.8f * inside + 0.15f * streak(u, v, z);
             // A fibre keeps (u, v) while z runs: its direction is (−∂u/∂z, −∂v/∂z, 1) to first order.
             constexpr float h = 1e-3f;
             const float slope_x = amplitude * (sway_x(x, y, z + h) - sway_x(x, y, z - h)) / (2 * h);
             const float slope_y = amplitude * (sway_y(x, y, z + h) - sway_y(x, y, z - h)) / (2 * h);
             const float length = std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
             m[4] = -slope_x / length;
             m[5] = -slope_y / length;
             m[6] = 1.0f / length;
             return m;
           }},
      options);
}

} // namespace pith
