#pragma once
// Reading one exemplar or mask at one place: wrap, decode, interpolate linearly along every axis.
#include "volume/base/lanes.h"
#include "volume/layer/exemplar.h"
#include "volume/layer/mask.h"

#include <span>

namespace pith {

/// One resolution of an exemplar's texels (or of its Gaussian twin), laid out for reading. One lane per axis.
struct TexelGrid {
  const std::uint8_t* texel = nullptr;
  int axes = 3;
  int components = 3;
  Lanes texels{};                       ///< along each axis
  IntLanes stride{};                    ///< bytes from one texel to the next along each axis
  IntLanes repeats{}, mirrors{};        ///< −1 where the axis wraps so
  IntLanes count{}, before{}, behind{}; ///< texels, and which of them lie beyond the ends
};
TexelGrid texel_grid(const Exemplar& exemplar, std::span<const std::uint8_t> texels);

/// For each component the 256 decoded values of a byte.
using DecodeTable = std::vector<std::array<float, 256>>;
DecodeTable decode_table(const Exemplar& exemplar);

/// The texels around a position: per axis the byte offsets of the two and the weight of the second.
struct TexelCell {
  IntLanes low, high;
  Lanes fraction;
};

/// `position` in texture widths; wrapped as the grid says. No branch depends on where it is: folded into [0, 1]
/// first, so that only the ends need care.
inline TexelCell cell_at(const TexelGrid& grid, Lanes position) {
  constexpr float far = 1e8f; // not a number: −far
  const Lanes p = smaller_of(position > -far ? position : all_lanes(-far), all_lanes(far));
  const Lanes repeated = p - floor_of(p), half = p - 2 * floor_of(0.5f * p + 0.5f);
  const Lanes mirrored = half < 0 ? -half : half;
  const Lanes clamped = smaller_of(larger_of(p, all_lanes(0)), all_lanes(1));
  const Lanes folded = grid.repeats ? repeated : grid.mirrors ? mirrored : clamped;
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
  const std::uint8_t* row = grid.texel + std::uint32_t(cell.low[0]);
  for (const std::uint32_t z : {std::uint32_t(cell.low[2]), std::uint32_t(cell.high[2])})
    for (const std::uint32_t y : {std::uint32_t(cell.low[1]), std::uint32_t(cell.high[1])})
      __builtin_prefetch(row + y + z);
}

/// result[0 … components − 1] = the decoded, interpolated values.
void sample(const TexelGrid& grid, const DecodeTable& decode, const TexelCell& cell, float* result);

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
  /// Asks the memory for what alpha() will read.
  void prefetch(Lanes position) const {
    const std::uint8_t* cell = alpha_.data() + index_of(__builtin_convertvector(inside_of(position), IntLanes));
    __builtin_prefetch(cell);
    __builtin_prefetch(cell + slice_);
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
