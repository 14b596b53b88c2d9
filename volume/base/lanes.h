#pragma once
// Four numbers at once: what a texture look-up does alike on each of its axes. The compiler's vector types: operators
// work lane by lane, comparisons give 0 or −1 in each lane, `condition ? a : b` chooses lane by lane.
#include <cstdint>
#include <cstring>

namespace pith {

using Lanes = float __attribute__((vector_size(16)));
using IntLanes = std::int32_t __attribute__((vector_size(16)));

inline Lanes all_lanes(float value) { return Lanes{value, value, value, value}; }

/// Four numbers from any address.
inline Lanes lanes_at(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

/// Towards minus infinity; for values within the range of an int.
inline Lanes floor_of(Lanes x) {
  const Lanes toward_zero = __builtin_convertvector(__builtin_convertvector(x, IntLanes), Lanes);
  return toward_zero > x ? toward_zero - 1.0f : toward_zero;
}

inline Lanes smaller_of(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes larger_of(Lanes a, Lanes b) { return a > b ? a : b; }

} // namespace pith
