#include "volume/exemplar/tile_noise.h"

namespace pith {

TileNoise::TileNoise(std::uint64_t key, std::array<int, 3> cells, Tiling tiling)
    : cells_(cells), repeat_{tiling.x, tiling.y, tiling.z} {
  int stride = 1;
  for (int a = 0; a < 3; ++a) {
    count_[a] = cells[a] + (repeat_[a] ? 0 : 1);
    stride_[a] = stride;
    if (repeat_[a]) shift_[a] = float(unit_double(hash_of(key, 0x5f, a)));
    stride *= count_[a];
  }
  corner_.resize(std::size_t(stride));
  for (std::size_t i = 0; i < corner_.size(); ++i) corner_[i] = float(2.0 * unit_double(hash_of(key, i)) - 1.0);
}

FractalNoise::FractalNoise(std::uint64_t key, std::array<int, 3> cells, int octaves, Tiling tiling) {
  float strength = 0.5f, sum = 0;
  for (int octave = 0; octave < octaves; ++octave) {
    octave_.emplace_back(hash_of(key, octave), cells, tiling);
    for (int& n : cells) n *= 2;
    sum += strength;
    strength *= 0.5f;
  }
  scale_ = 1.0f / sum;
}

ScatteredPoints::ScatteredPoints(std::uint64_t key, std::array<int, 3> cells, float jitter, Tiling tiling)
    : cells_(cells), repeat_{tiling.x, tiling.y, tiling.z}, own_(std::size_t(cells[0]) * cells[1] * cells[2]) {
  for (int a = 0; a < 3; ++a) size_[a] = 1.0f / float(cells[a]);
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const std::uint64_t hash = hash_of(key, i);
    for (int a = 0; a < 3; ++a)
      own_[i].place[a] = 0.5f + jitter * (float((hash >> (21 * a)) & 0x1fffff) / float(0x1fffff) * 2.0f - 1.0f);
    own_[i].hash = mix_bits(hash);
  }
}

ScatteredPoints::Nearest ScatteredPoints::nearest(float x, float y, float z) const {
  Nearest result;
  near(x, y, z, [&](const Point3f& offset, std::uint64_t hash) {
    float squared = 0;
    for (int a = 0; a < 3; ++a) {
      const float d = offset[a] * float(cells_[a]);
      squared += d * d;
    }
    const float distance = std::sqrt(squared);
    if (distance < result.first) {
      result.second = result.first;
      result.first = distance;
      result.offset = offset;
      result.hash = hash;
    } else if (distance < result.second) {
      result.second = distance;
    }
  });
  return result;
}

} // namespace pith
