#include "volume/exemplar/periodic_noise.h"

#include "volume/base/random.h"

#include <algorithm>
#include <cmath>

namespace pith {

PeriodicNoise::PeriodicNoise(std::uint64_t key, int cells_x, int cells_y, int cells_z)
    : cells_x_(cells_x), cells_y_(cells_y), cells_z_(cells_z),
      corner_(std::size_t(cells_x) * (cells_y + 1) * cells_z) {
  for (std::size_t i = 0; i < corner_.size(); ++i) corner_[i] = float(2.0 * unit_double(hash_of(key, i)) - 1.0);
}

void PeriodicNoise::read(float y, float z, Row& row) const {
  const auto fade = [](float t) { return t * t * (3.0f - 2.0f * t); };
  const float scaled_y = std::clamp(y, 0.0f, 1.0f) * float(cells_y_);
  const int y0 = std::min(int(scaled_y), cells_y_ - 1);
  const float ty = fade(scaled_y - float(y0));
  const float scaled_z = (z - std::floor(z)) * float(cells_z_);
  const int z0 = std::min(int(scaled_z), cells_z_ - 1), z1 = (z0 + 1) % cells_z_;
  const float tz = fade(scaled_z - float(z0));
  const auto line = [&](int j, int k) { return corner_.data() + (std::size_t(k) * (cells_y_ + 1) + j) * cells_x_; };
  const float *a = line(y0, z0), *b = line(y0 + 1, z0), *c = line(y0, z1), *d = line(y0 + 1, z1);
  row.cells_ = cells_x_;
  row.value_.resize(cells_x_ + 1);
  for (int i = 0; i < cells_x_; ++i) {
    const float low = a[i] + (b[i] - a[i]) * ty, high = c[i] + (d[i] - c[i]) * ty;
    row.value_[i] = low + (high - low) * tz;
  }
  row.value_[cells_x_] = row.value_[0];
}

float PeriodicNoise::value(float x, float y, float z) const {
  Row row;
  read(y, z, row);
  return row.at(x);
}

} // namespace pith
