#pragma once
// Counter-based random numbers: every number is a pure function of its key, so that results depend neither on the number
// of threads nor on the order of work. Keys are (seed, stage, element, ...).
#include <cstdint>

namespace pith {

/// A bijective mixing of 64 bits (the finaliser of SplitMix64: Steele, Lea, Flood 2014).
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// One 64-bit hash of any number of integers; the order matters.
template <class... Keys>
constexpr std::uint64_t hash_of(std::uint64_t first, Keys... rest) {
  std::uint64_t h = mix_bits(first);
  ((h = mix_bits(h ^ (static_cast<std::uint64_t>(rest) + 0x632be59bd9b4e019ull))), ...);
  return h;
}

/// A uniform number in [0, 1) from a hash: 53 bits.
constexpr double unit_double(std::uint64_t hash) { return static_cast<double>(hash >> 11) * 0x1.0p-53; }

/// A stream of numbers for one element: `Random r(seed, stage, element); r.uniform();`
class Random {
public:
  template <class... Keys>
  explicit constexpr Random(std::uint64_t seed, Keys... keys) : key_(hash_of(seed, keys...)) {}

  constexpr std::uint64_t bits() { return hash_of(key_, counter_++); }
  constexpr double uniform() { return unit_double(bits()); }
  constexpr double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// An integer in [0, count); count ≥ 1. The bias is below 2⁻³² for counts below 2³².
  constexpr std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>(((bits() >> 32) * count) >> 32);
  }
  /// A standard normal number (sum of twelve uniforms would be cruder; this is Box–Muller's first half).
  double normal();

private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

} // namespace pith
