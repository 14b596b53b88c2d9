#pragma once
// Reading one exemplar at one place: wrap, decode, interpolate linearly along every axis.
#include "volume/layer/exemplar.h"

namespace pith {

/// One resolution of an exemplar's texels (or of its Gaussian twin), laid out for reading.
struct TexelGrid {
  const std::uint8_t* texel = nullptr;
  int axes = 3;
  int components = 3;
  std::array<int, 4> size{1, 1, 1, 1};
  std::array<Wrap, 4> wrap{};
  std::array<std::uint32_t, 4> stride{}; ///< bytes from one texel to the next along each axis
};
TexelGrid texel_grid(const Exemplar& exemplar, const std::vector<std::uint8_t>& texels);

/// For each component the 256 decoded values of a byte.
using DecodeTable = std::vector<std::array<float, 256>>;
DecodeTable decode_table(const Exemplar& exemplar);

/// result[0 … components − 1] = the decoded, interpolated values at `position` (axes numbers in texture widths).
void sample(const TexelGrid& grid, const DecodeTable& decode, const float* position, float* result);

} // namespace pith
