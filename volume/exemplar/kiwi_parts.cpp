#include "volume/exemplar/kiwi_parts.h"

#include "volume/base/parallel.h"
#include "volume/base/random.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pith {

namespace {

float wrapped(float difference) { return difference - std::round(difference); }

/// Whether two seeds come closer than `gap`. Near enough: the ellipsoid of the summed half axes stands for their
/// Minkowski sum, and the gap is wider than the difference.
bool too_close(const KiwiSeed& a, const KiwiSeed& b, float gap) {
  const float across = a.half_width + b.half_width + gap, along = a.half_length + b.half_length + gap;
  const float dx = wrapped(a.x - b.x) / across, dy = (a.y - b.y) / along, dz = wrapped(a.z - b.z) / across;
  return dx * dx + dy * dy + dz * dz < 1.0f;
}

float depth_at_radius(float radius) { return 1.0f - radius * radius; }

} // namespace

float kiwi_radius_at_depth(float depth) { return std::sqrt(std::max(0.0f, 1.0f - depth)); }

std::vector<KiwiSeed> kiwi_seeds(std::uint64_t seed) {
  // Measured in the photographed section: seeds lie at 0.30 … 0.56 of the radius, are 0.079 ± 0.01 of it long and
  // 0.042 wide where cut whole. They are drawn a little larger (0.094 and 0.052: 2.3 × 1.3 mm in a fruit 49 mm wide).
  constexpr int rows = 3, per_row = 17;
  constexpr std::array<float, rows + 1> radius_of_row{0.325f, 0.390f, 0.455f, 0.535f};
  constexpr float gap = 0.013f;
  const PeriodicNoise warp = kiwi::locule_warp(seed);
  std::vector<KiwiSeed> seeds;
  for (int locule = 0; locule < kiwi_locules; ++locule)
    for (int row = 0; row < rows; ++row)
      for (int k = 0; k < per_row; ++k) {
        Random random(seed, kiwi::stage_seed, locule, row, k);
        if (random.uniform() < 0.08) continue; // some ovules never became seeds
        for (int attempt = 0; attempt < 12; ++attempt) {
          const float radius = float(random.uniform(radius_of_row[row], radius_of_row[row + 1]));
          const float size = float(random.uniform(0.86, 1.10));
          KiwiSeed s;
          s.y = depth_at_radius(radius);
          s.half_length = 0.094f * radius * size;
          s.half_width = 0.052f * radius * size;
          s.z = (float(k) + 0.5f * float(row) + float(random.uniform(-0.30, 0.30)) + 0.31f * float(locule)) / per_row;
          s.z -= std::floor(s.z);
          const float center = (float(locule) + 0.5f + float(random.uniform(-0.15, 0.15))) / kiwi_locules;
          s.x = center;
          for (int i = 0; i < 4; ++i) s.x = center - kiwi::warp_amplitude / kiwi_locules * warp.value(s.x, s.y, s.z);
          s.x -= std::floor(s.x);
          if (std::any_of(seeds.begin(), seeds.end(), [&](const KiwiSeed& t) { return too_close(s, t, gap); }))
            continue;
          seeds.push_back(s);
          break;
        }
      }
  return seeds;
}

namespace kiwi {

PeriodicNoise locule_warp(std::uint64_t seed) { return {hash_of(seed, stage_warp), 9, 4, 2}; }

std::vector<KiwiSeed> specks(std::uint64_t seed) {
  constexpr int count = 11000;
  std::vector<KiwiSeed> result(count);
  for (int i = 0; i < count; ++i) {
    Random random(seed, stage_speck, i);
    KiwiSeed& s = result[i];
    s.x = float(random.uniform());
    s.y = float(random.uniform(0.05, 0.90));
    s.z = float(random.uniform());
    const float radius = kiwi_radius_at_depth(s.y);
    s.half_width = radius * float(random.uniform(0.004, 0.009));
    s.half_length = s.half_width * float(random.uniform(1.5, 4.0));
  }
  return result;
}

namespace {

/// Calls body(index, q) for the texels of the slice near a thing; q is 0 at its centre, 1 on its surface.
template <class Body>
void for_texels_near(const KiwiSeed& s, int n, float z, float reach, float taper, const Body& body) {
  const float dz = wrapped(z - s.z);
  if (std::fabs(dz) > reach * s.half_width * (1.0f + taper)) return;
  const float width = reach * s.half_width * (1.0f + taper), length = reach * s.half_length;
  const int y0 = std::max(0, int(std::ceil((s.y - length) * n - 0.5f)));
  const int y1 = std::min(n - 1, int(std::floor((s.y + length) * n - 0.5f)));
  const int x0 = int(std::ceil((s.x - width) * n - 0.5f)), x1 = int(std::floor((s.x + width) * n - 0.5f));
  for (int j = y0; j <= y1; ++j) {
    const float t = ((float(j) + 0.5f) / n - s.y) / s.half_length;
    const float here = s.half_width * (1.0f - taper * std::clamp(t, -1.0f, 1.0f)); // narrower towards the core
    for (int i = x0; i <= x1; ++i) {
      const float dx = (float(i) + 0.5f) / n - s.x;
      const float q = std::sqrt(t * t + (dx * dx + dz * dz) / (here * here));
      if (q < reach) body(std::size_t(j) * n + (i % n + n) % n, q);
    }
  }
}

} // namespace

void draw_things(const std::vector<KiwiSeed>& seeds, const std::vector<KiwiSeed>& specks, int resolution, float z,
                 SliceThings& slice) {
  constexpr float seed_edge = 0.0036f, speck_edge = 0.004f, halo = 2.2f; // half widths of the soft borders
  const std::size_t count = std::size_t(resolution) * resolution;
  for (std::vector<float>* each : {&slice.seed, &slice.shade, &slice.speck}) each->assign(count, 0.0f);
  for (const KiwiSeed& s : seeds)
    for_texels_near(s, resolution, z, halo, 0.2f, [&](std::size_t at, float q) {
      const float inside = std::clamp(0.5f + (1.0f - q) * s.half_width / (2.0f * seed_edge), 0.0f, 1.0f);
      const float near = std::clamp((halo - q) / (halo - 1.0f), 0.0f, 1.0f);
      slice.seed[at] = std::max(slice.seed[at], inside);
      slice.shade[at] = std::max(slice.shade[at], near * near);
    });
  for (const KiwiSeed& s : specks)
    for_texels_near(s, resolution, z, 1.0f + speck_edge / s.half_width, 0.0f, [&](std::size_t at, float q) {
      const float inside = std::clamp(0.5f + (1.0f - q) * s.half_width / (2.0f * speck_edge), 0.0f, 1.0f);
      slice.speck[at] = std::max(slice.speck[at], inside);
    });
}

std::vector<float> hair_brightness(std::uint64_t seed, int resolution) {
  // A texture width at the skin is half the fruit's radius, 12 mm: hairs are 0.8 … 2.6 mm long and 0.12 mm thick.
  struct Hair {
    float x, z, half, cosine, sine, bend, shade;
  };
  constexpr int count = 1900;
  constexpr float thickness = 0.0050f, edge = 0.0040f;
  std::vector<Hair> hairs(count);
  for (int i = 0; i < count; ++i) {
    Random random(seed, stage_hair, i);
    Hair& h = hairs[i];
    h.x = float(random.uniform());
    h.z = float(random.uniform());
    h.half = float(random.uniform(0.035, 0.11));
    const float angle = float((random.uniform() + random.uniform() - 1.0) * 1.1); // from T, radians
    h.cosine = std::cos(angle);
    h.sine = std::sin(angle);
    h.bend = float(random.uniform(-0.35, 0.35));
    h.shade = float(0.5 + 0.5 * random.uniform() * random.uniform());
  }
  const PeriodicNoise mottle(hash_of(seed, stage_hair, 1u << 30), 7, 1, 7);
  const PeriodicNoise grain(hash_of(seed, stage_hair, (1u << 30) + 1), 48, 1, 48);
  std::vector<float> result(std::size_t(resolution) * resolution);
  parallel_for(resolution, 4, [&](std::size_t k) {
    const float z = (float(k) + 0.5f) / resolution;
    float* row = result.data() + k * resolution;
    PeriodicNoise::Row large, small;
    mottle.read(0.5f, z, large);
    grain.read(0.5f, z, small);
    for (int i = 0; i < resolution; ++i) {
      const float x = (float(i) + 0.5f) / resolution;
      row[i] = std::clamp(0.30f + 0.14f * large.at(x) + 0.13f * small.at(x), 0.0f, 1.0f);
    }
    for (const Hair& h : hairs) {
      const float dz = wrapped(z - h.z);
      const float reach = h.half * (1.0f + std::fabs(h.bend)) + 3 * thickness;
      if (std::fabs(dz) > reach) continue;
      const int i0 = int(std::ceil((h.x - reach) * resolution - 0.5f));
      const int i1 = int(std::floor((h.x + reach) * resolution - 0.5f));
      for (int i = i0; i <= i1; ++i) {
        const float dx = (float(i) + 0.5f) / resolution - h.x;
        const float along = (dx * h.sine + dz * h.cosine) / h.half;
        if (std::fabs(along) > 1.0f) continue;
        const float across = dx * h.cosine - dz * h.sine - h.bend * h.half * (along * along - 0.4f);
        const float thick = thickness * (1.0f - 0.6f * along * along);
        const float cover = std::clamp(0.5f + (thick - std::fabs(across)) / (2.0f * edge), 0.0f, 1.0f);
        const float shadow =
            std::clamp(0.5f + (thick - std::fabs(across - 2.2f * thickness)) / (2.0f * edge), 0.0f, 1.0f);
        float& value = row[(i % resolution + resolution) % resolution];
        value *= 1.0f - 0.35f * shadow;
        value += (h.shade - value) * cover;
      }
    }
  });
  return result;
}

} // namespace kiwi

} // namespace pith
