#pragma once
// Places along Morton's space-filling curve: cells whose codes are near are near in space, mostly.
#include <array>
#include <cstdint>

namespace pith {

/// The lowest 21 bits of x at every third place.
constexpr std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// The code of a cell of a grid of at most 2²¹ cells along each axis; x counts least.
constexpr std::uint64_t morton_code(const std::array<std::int32_t, 3>& at) {
  return spread_bits(static_cast<std::uint64_t>(at[0])) | spread_bits(static_cast<std::uint64_t>(at[1])) << 1 |
         spread_bits(static_cast<std::uint64_t>(at[2])) << 2;
}

} // namespace pith
