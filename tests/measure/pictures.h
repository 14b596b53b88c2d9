#pragma once
// Pictures for the tests of measures: noise of a known make, and what spoils it step by step.
#include "volume/base/random.h"
#include "volume/measure/slice.h"

#include <algorithm>
#include <cmath>

namespace pith::testing {

inline Slice slice_of(int width, int height) {
  Slice s;
  s.color = Image(width, height, 3);
  s.inside.assign(std::size_t(width) * height, 1);
  s.depth.assign(std::size_t(width) * height, 0);
  return s;
}

/// Blobs of two scales around grey, with a colour of their own: a texture with structure. Linear light in [0.05,
/// 0.95].
inline Slice textured(std::uint64_t seed, int size = 48) {
  Slice s = slice_of(size, size);
  const auto noise = [&](int cell, std::uint64_t key, int x, int y) {
    const double fx = double(x) / cell, fy = double(y) / cell;
    const int ix = int(fx), iy = int(fy);
    const auto at = [&](int i, int j) { return unit_double(hash_of(seed, key, i, j)); };
    const double tx = fx - ix, ty = fy - iy;
    return (1 - ty) * ((1 - tx) * at(ix, iy) + tx * at(ix + 1, iy)) +
           ty * ((1 - tx) * at(ix, iy + 1) + tx * at(ix + 1, iy + 1));
  };
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double coarse = noise(8, 1, x, y), fine = noise(3, 2, x, y);
      const double v = 0.05 + 0.9 * (0.6 * coarse + 0.4 * fine);
      float* p = s.color.at(x, y);
      p[0] = float(v), p[1] = float(0.5 * v + 0.25), p[2] = float(0.9 - 0.8 * v);
    }
  return s;
}

inline std::vector<Slice> textured_set(std::uint64_t seed, int count = 12) {
  std::vector<Slice> set;
  for (int i = 0; i < count; ++i) set.push_back(textured(hash_of(seed, i)));
  return set;
}

/// The mean of (2 radius + 1)² pixels.
inline Slice blurred(const Slice& s, int radius) {
  Slice result = s;
  for (int y = 0; y < s.height(); ++y)
    for (int x = 0; x < s.width(); ++x)
      for (int c = 0; c < 3; ++c) {
        float sum = 0;
        int count = 0;
        for (int j = std::max(0, y - radius); j <= std::min(s.height() - 1, y + radius); ++j)
          for (int i = std::max(0, x - radius); i <= std::min(s.width() - 1, x + radius); ++i, ++count)
            sum += s.color.at(i, j)[c];
        result.color.at(x, y)[c] = sum / count;
      }
  return result;
}

/// Towards grey by `loss` (0: as it is, 1: grey).
inline Slice faded(const Slice& s, float loss) {
  Slice result = s;
  for (float& v : result.color.pixel) v += loss * (0.5f - v);
  return result;
}

/// A part of the pixels exchanged at random with one another: the same colours, less structure.
inline Slice shuffled(const Slice& s, double part, std::uint64_t seed) {
  Slice result = s;
  Random random(seed);
  const std::size_t pixels = s.inside.size();
  for (std::size_t k = 0; k < std::size_t(part * double(pixels) / 2); ++k) {
    const std::size_t a = random.below(std::uint32_t(pixels)), b = random.below(std::uint32_t(pixels));
    for (int c = 0; c < 3; ++c) std::swap(result.color.pixel[3 * a + c], result.color.pixel[3 * b + c]);
  }
  return result;
}

template <class Change>
std::vector<Slice> changed(const std::vector<Slice>& set, const Change& change) {
  std::vector<Slice> result;
  for (std::size_t i = 0; i < set.size(); ++i) result.push_back(change(set[i], i));
  return result;
}

} // namespace pith::testing
