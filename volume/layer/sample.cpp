#include "volume/layer/sample.h"

#include <algorithm>
#include <cmath>

namespace pith {

TexelGrid texel_grid(const Exemplar& exemplar, std::span<const std::uint8_t> texels) {
  TexelGrid grid;
  grid.texel = texels.data();
  grid.axes = exemplar.axes;
  grid.components = exemplar.component_count();
  std::uint32_t stride = grid.components;
  for (int axis = 0; axis < 4; ++axis) {
    const int n = exemplar.size[axis];
    const bool repeats = exemplar.wrap[axis] == Wrap::repeat;
    grid.texels[axis] = static_cast<float>(n);
    grid.count[axis] = n;
    grid.stride[axis] = static_cast<std::int32_t>(stride);
    grid.repeats[axis] = repeats ? -1 : 0;
    grid.mirrors[axis] = exemplar.wrap[axis] == Wrap::mirror ? -1 : 0;
    grid.before[axis] = repeats ? n - 1 : 0;
    grid.behind[axis] = repeats ? 0 : n - 1;
    stride *= n;
  }
  return grid;
}

DecodeTable decode_table(const Exemplar& exemplar) {
  DecodeTable table;
  for (const Channel& channel : exemplar.channel) {
    std::array<float, 256> values;
    for (int byte = 0; byte < 256; ++byte) values[byte] = decoded(channel, static_cast<std::uint8_t>(byte));
    for (int c = 0; c < channel.components; ++c) table.push_back(values);
  }
  return table;
}

namespace {

/// The two texels along one axis, as byte offsets, and the weight of the second.
struct Span {
  std::uint32_t low, high;
  float fraction;
};
inline Span span_of(const TexelCell& cell, int axis) {
  return {std::uint32_t(cell.low[axis]), std::uint32_t(cell.high[axis]), cell.fraction[axis]};
}

template <int Components>
inline void sample_square(const TexelGrid& grid, const DecodeTable& decode, const Span& x, const Span& y,
                          std::uint32_t base, float* result) {
  const std::uint8_t* a = grid.texel + base + y.low;
  const std::uint8_t* b = grid.texel + base + y.high;
  const int components = Components ? Components : grid.components;
  const float w11 = x.fraction * y.fraction, w10 = x.fraction - w11, w01 = y.fraction - w11;
  const float w00 = 1 - x.fraction - w01;
  for (int c = 0; c < components; ++c) {
    const float* value = decode[c].data();
    result[c] = w00 * value[a[x.low + c]] + w10 * value[a[x.high + c]] + w01 * value[b[x.low + c]] +
                w11 * value[b[x.high + c]];
  }
}

template <int Components>
inline void sample_cube(const TexelGrid& grid, const DecodeTable& decode, const TexelCell& cell, std::uint32_t base,
                        float* result) {
  const Span x = span_of(cell, 0), y = span_of(cell, 1), z = span_of(cell, 2);
  std::array<float, Components ? Components : max_components> far;
  const int components = Components ? Components : grid.components;
  sample_square<Components>(grid, decode, x, y, base + z.low, result);
  sample_square<Components>(grid, decode, x, y, base + z.high, far.data());
  for (int c = 0; c < components; ++c) result[c] += z.fraction * (far[c] - result[c]);
}

} // namespace

void sample(const TexelGrid& grid, const DecodeTable& decode, const TexelCell& cell, float* result) {
  if (grid.axes == 2) return sample_square<0>(grid, decode, span_of(cell, 0), span_of(cell, 1), 0, result);
  if (grid.axes == 3) {
    if (grid.components == 3) return sample_cube<3>(grid, decode, cell, 0, result);
    return sample_cube<0>(grid, decode, cell, 0, result);
  }
  const Span w = span_of(cell, 3);
  std::array<float, max_components> far;
  sample_cube<0>(grid, decode, cell, w.low, result);
  sample_cube<0>(grid, decode, cell, w.high, far.data());
  for (int c = 0; c < grid.components; ++c) result[c] += w.fraction * (far[c] - result[c]);
}

MaskGrid::MaskGrid(const Mask& mask) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  std::array<std::uint32_t, 3> size{};
  for (int axis = 0; axis < 4; ++axis) {
    const bool used = axis < mask.axes, open = !used || mask.open[axis];
    const int n = used ? mask.size[axis] : 1;
    if (axis < 3) size[axis] = n;
    low_[axis] = open ? -infinity : 0;
    high_[axis] = open ? infinity : 1;
    texels_[axis] = used ? static_cast<float>(n) : 0; // 0: the only texel, wherever it is read
    last_[axis] = static_cast<float>(n - 1);
  }
  row_ = size[0] + 1;
  slice_ = row_ * (size[1] + 1);
  alpha_.reserve(std::size_t(slice_) * (size[2] + 1));
  for (std::uint32_t z = 0; z <= size[2]; ++z)
    for (std::uint32_t y = 0; y <= size[1]; ++y)
      for (std::uint32_t x = 0; x <= size[0]; ++x)
        alpha_.push_back(
            mask.alpha[(std::size_t(std::min(z, size[2] - 1)) * size[1] + std::min(y, size[1] - 1)) * size[0] +
                       std::min(x, size[0] - 1)]);
}

} // namespace pith
