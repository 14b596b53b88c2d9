#pragma once
// Reading one exemplar or mask at one place: wrap, decode, interpolate linearly along every axis.
#include "volume/base/lanes.h"
#include "volume/layer/exemplar.h"
#include "volume/layer/mask.h"

#include <span>

namespace pith {

/// One resolution of an exemplar's texels (or of its Gaussian twin), decoded and laid out for reading: components
/// side by side, 0 for the least value that a component has, 65535 for its largest. That is 256 times finer than a
/// byte, and interpolates as it is. One lane per axis.
struct TexelGrid {
  int axes = 3;
  int components = 3;
  Lanes texels{};                       ///< along each axis
  IntLanes stride{};                    ///< numbers from one texel to the next along each axis
  IntLanes repeats{}, mirrors{};        ///< −1 where the axis wraps so
  IntLanes count{}, before{}, behind{}; ///< texels, and which of them lie beyond the ends
  bool any_mirror = false;
  std::array<Lanes, max_components / 4> low{}, step{}; ///< per four components: value = low + step · number
  LargeArray<std::uint16_t> texel;                     ///< and three more numbers: read four at a time
};

/// For each component the 256 decoded values of a byte.
using DecodeTable = std::vector<std::array<float, 256>>;
DecodeTable decode_table(const Exemplar& exemplar);

TexelGrid texel_grid(const Exemplar& exemplar, std::span<const std::uint8_t> texels, const DecodeTable& decode);

/// The means over some axes: one texel along each of those.
TexelGrid mean_grid(const TexelGrid& grid, const std::array<bool, 4>& over);

/// The texels around a position: per axis the offsets of the two and the weight of the second.
struct TexelCell {
  IntLanes low, high;
  Lanes fraction;
};

/// `position` in texture widths; wrapped as the grid says. No branch depends on where it is: folded into [0, 1]
/// first, so that only the ends need care.
inline TexelCell cell_at(const TexelGrid& grid, Lanes position) {
  constexpr float far = 1e8f; // not a number: −far
  const Lanes p = smaller_of(position > -far ? position : all_lanes(-far), all_lanes(far));
  Lanes folded = grid.repeats ? p - floor_of(p) : smaller_of(larger_of(p, all_lanes(0)), all_lanes(1));
  if (grid.any_mirror) {
    const Lanes half = p - 2 * floor_of(0.5f * p + 0.5f);
    folded = grid.mirrors ? (half < 0 ? -half : half) : folded;
  }
  const Lanes at = folded * grid.texels - 0.5f;
  const IntLanes i = __builtin_convertvector(at + 1, IntLanes) - 1; // floor: at ≥ −½
  TexelCell cell;
  cell.low = (i < 0 ? grid.before : i) * grid.stride;
  cell.high = (i + 1 < grid.count ? i + 1 : grid.behind) * grid.stride;
  cell.fraction = at - __builtin_convertvector(i, Lanes);
  return cell;
}

/// Asks the memory for the texels of a cell, so that they are there when sample() comes.
inline void prefetch(const TexelGrid& grid, const TexelCell& cell) {
  const std::uint16_t* row = grid.texel.data() + std::uint32_t(cell.low[0]);
  for (const std::uint32_t z : {std::uint32_t(cell.low[2]), std::uint32_t(cell.high[2])})
    for (const std::uint32_t y : {std::uint32_t(cell.low[1]), std::uint32_t(cell.high[1])})
      __builtin_prefetch(row + y + z);
}

/// The decoded, interpolated values of components 4 · block … 4 · block + 3.
inline Lanes sample(const TexelGrid& grid, const TexelCell& cell, int block) {
  using Four = std::uint16_t __attribute__((vector_size(8)));
  const auto at = [texel = grid.texel.data() + 4 * block](std::uint32_t offset) {
    Four number;
    std::memcpy(&number, texel + offset, sizeof number);
    return __builtin_convertvector(number, Lanes);
  };
  const std::uint32_t x0 = cell.low[0], x1 = cell.high[0], y0 = cell.low[1], y1 = cell.high[1];
  const float fx = cell.fraction[0], fy = cell.fraction[1];
  const float w11 = fx * fy, w10 = fx - w11, w01 = fy - w11, w00 = 1 - fx - w01;
  const auto square = [&](std::uint32_t base) {
    return (w00 * at(base + y0 + x0) + w10 * at(base + y0 + x1)) +
           (w01 * at(base + y1 + x0) + w11 * at(base + y1 + x1));
  };
  const auto cube = [&](std::uint32_t base) {
    const Lanes first = square(base + cell.low[2]);
    return first + cell.fraction[2] * (square(base + cell.high[2]) - first);
  };
  Lanes number;
  if (grid.axes == 3) {
    number = cube(0);
  } else if (grid.axes == 2) {
    number = square(0);
  } else {
    const Lanes first = cube(cell.low[3]);
    number = first + cell.fraction[3] * (cube(cell.high[3]) - first);
  }
  return grid.low[block] + grid.step[block] * number;
}

/// result[0 … components − 1] = all values.
inline void sample(const TexelGrid& grid, const TexelCell& cell, float* result) {
  for (int block = 0; 4 * block < grid.components; ++block) {
    const Lanes values = sample(grid, cell, block);
    for (int c = 0; c < std::min(4, grid.components - 4 * block); ++c) result[4 * block + c] = values[c];
  }
}

/// A mask laid out for reading: with one more texel along each axis, a repetition, so that the eight around a place
/// lie in four pairs.
class MaskGrid {
public:
  explicit MaskGrid(const Mask& mask);

  /// False where the alpha is certainly 0: outside [0, 1] along an axis that is not open.
  bool reaches(Lanes position) const {
    const IntLanes in = (position >= low_) & (position <= high_);
    return (in[0] & in[1] & in[2]) != 0;
  }
  /// In [0, 1], interpolated linearly.
  float alpha(Lanes position) const {
    if (!reaches(position)) return 0;
    const Lanes inside = inside_of(position);
    const IntLanes i = __builtin_convertvector(inside, IntLanes);
    const Lanes f = inside - __builtin_convertvector(i, Lanes);
    const std::uint8_t* cell = alpha_.data() + index_of(i);
    const auto row = [&](const std::uint8_t* a) { return a[0] + f[0] * (a[1] - a[0]); };
    const auto slice = [&](const std::uint8_t* a) {
      const float first = row(a);
      return first + f[1] * (row(a + row_) - first);
    };
    const float first = slice(cell);
    return (first + f[2] * (slice(cell + slice_) - first)) * (1 / 255.0f);
  }

private:
  Lanes inside_of(Lanes position) const {
    return smaller_of(larger_of(position * texels_ - 0.5f, all_lanes(0)), last_);
  }
  std::uint32_t index_of(IntLanes i) const {
    return std::uint32_t(i[0]) + std::uint32_t(i[1]) * row_ + std::uint32_t(i[2]) * slice_;
  }

  Lanes low_, high_;    ///< where it reaches
  Lanes texels_, last_; ///< along each axis; the last one's number
  std::uint32_t row_ = 0, slice_ = 0;
  LargeArray<std::uint8_t> alpha_;
};

} // namespace pith
