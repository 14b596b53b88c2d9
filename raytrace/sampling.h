#pragma once
// Numbers for samples of a pixel, and the maps from the unit square to directions.
//
// The sequence follows Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020: every pair of dimensions is a
// two-dimensional Sobol' sequence whose order and digits are scrambled by a hash of (seed, pixel, pair). A sample is
// a function of (seed, pixel, sample, dimension) alone.
#include "volume/base/random.h"
#include "volume/base/types.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace pith {

namespace detail {

constexpr std::uint32_t reversed_bits(std::uint32_t x) {
  x = ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
  x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
  x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
  return (x >> 16) | (x << 16);
}

/// Burley's listing 3, after Laine and Karras, 2011: each bit is flipped by a hash of the bits below it.
constexpr std::uint32_t laine_karras_permutation(std::uint32_t x, std::uint32_t seed) {
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return x;
}

constexpr std::uint32_t nested_uniform_scramble(std::uint32_t x, std::uint32_t seed) {
  return reversed_bits(laine_karras_permutation(reversed_bits(x), seed));
}

/// The second dimension of Sobol's sequence, byte by byte of the index.
struct SecondSobolDimension {
  std::array<std::array<std::uint32_t, 256>, 4> part{};
  constexpr SecondSobolDimension() {
    std::uint32_t direction[32] = {0x80000000u};
    for (int i = 1; i < 32; ++i) direction[i] = direction[i - 1] ^ (direction[i - 1] >> 1);
    for (int byte = 0; byte < 4; ++byte)
      for (int value = 0; value < 256; ++value)
        for (int bit = 0; bit < 8; ++bit)
          if (value >> bit & 1) part[byte][value] ^= direction[8 * byte + bit];
  }
  constexpr std::uint32_t operator()(std::uint32_t index) const {
    return part[0][index & 255] ^ part[1][index >> 8 & 255] ^ part[2][index >> 16 & 255] ^ part[3][index >> 24];
  }
};
inline constexpr SecondSobolDimension second_sobol_dimension{};

} // namespace detail

/// The numbers of one sample of one pixel, two at a time, all in [0, 1).
class PixelSampler {
public:
  PixelSampler(std::uint64_t seed, std::uint64_t pixel, std::uint32_t sample)
      : key_(hash_of(seed, pixel)), sample_(sample) {}

  /// Which pair comes next. Parts of a path that may or may not happen start at fixed pairs of their own.
  void go_to(std::uint32_t pair) { pair_ = pair; }

  std::array<double, 2> next() {
    const std::uint64_t a = hash_of(key_, pair_++), b = mix_bits(a);
    const std::uint32_t index = detail::nested_uniform_scramble(sample_, static_cast<std::uint32_t>(a));
    const std::uint32_t x =
        detail::nested_uniform_scramble(detail::reversed_bits(index), static_cast<std::uint32_t>(a >> 32));
    const std::uint32_t y =
        detail::nested_uniform_scramble(detail::second_sobol_dimension(index), static_cast<std::uint32_t>(b));
    return {x * 0x1.0p-32, y * 0x1.0p-32};
  }

private:
  std::uint64_t key_;
  std::uint32_t sample_;
  std::uint32_t pair_ = 0;
};

/// Three axes at right angles; local z is `normal`.
struct LocalFrame {
  Vec3d tangent, bitangent, normal;

  /// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
  explicit LocalFrame(const Vec3d& n) : normal(n) {
    const double sign = std::copysign(1.0, n.z());
    const double a = -1.0 / (sign + n.z()), b = n.x() * n.y() * a;
    tangent = {1.0 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()};
    bitangent = {b, sign + n.y() * n.y() * a, -n.y()};
  }
  Vec3d local(const Vec3d& w) const { return {w.dot(tangent), w.dot(bitangent), w.dot(normal)}; }
  Vec3d world(const Vec3d& l) const { return l.x() * tangent + l.y() * bitangent + l.z() * normal; }
};

/// Density cos θ / π around local z.
inline Vec3d cosine_direction(const std::array<double, 2>& u) {
  const double radius = std::sqrt(u[0]), angle = 2 * std::numbers::pi * u[1];
  return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(0.0, 1 - u[0]))};
}

/// Weight of a sample drawn with density `own` where `other` could have drawn it too (power heuristic; Veach 1997,
/// §9.2).
inline double power_heuristic(double own, double other) {
  if (!(own > 0)) return 0;
  const double ratio = other / own;
  return 1 / (1 + ratio * ratio);
}

/// Offset from a pixel's centre, in pixels, drawn from a Blackman–Harris window of radius 1.5 (standard deviation
/// 0.42): then every sample counts the same, for its own pixel.
class PixelFilter {
public:
  PixelFilter();
  double offset(double u) const;

private:
  std::array<double, 257> inverse_; ///< of the distribution function
};

} // namespace pith
