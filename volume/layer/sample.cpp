#include "volume/layer/sample.h"

#include <algorithm>
#include <cmath>

namespace pith {

TexelGrid texel_grid(const Exemplar& exemplar, const std::vector<std::uint8_t>& texels) {
  TexelGrid grid;
  grid.texel = texels.data();
  grid.axes = exemplar.axes;
  grid.components = exemplar.component_count();
  grid.size = exemplar.size;
  grid.wrap = exemplar.wrap;
  std::uint32_t stride = grid.components;
  for (int axis = 0; axis < 4; ++axis) {
    grid.stride[axis] = stride;
    stride *= exemplar.size[axis];
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

/// The two texels around a position along one axis, as byte offsets, and the weight of the second.
struct Span {
  std::uint32_t low, high;
  float fraction;
};

inline int wrapped(int i, int n, Wrap wrap) {
  if (static_cast<unsigned>(i) < static_cast<unsigned>(n)) return i;
  switch (wrap) {
  case Wrap::clamp:
    return i < 0 ? 0 : n - 1;
  case Wrap::repeat:
    return (i %= n) < 0 ? i + n : i;
  case Wrap::mirror: {
    const int period = 2 * n;
    if ((i %= period) < 0) i += period;
    return i < n ? i : period - 1 - i;
  }
  }
  return 0;
}

inline Span span_at(const TexelGrid& grid, int axis, float position) {
  const int n = grid.size[axis];
  const float at = std::clamp(position * n - 0.5f, -1e8f, 1e8f);
  int i = static_cast<int>(at);
  i -= at < i; // floor
  return {wrapped(i, n, grid.wrap[axis]) * grid.stride[axis], wrapped(i + 1, n, grid.wrap[axis]) * grid.stride[axis],
          at - i};
}

template <int Components>
void sample_square(const TexelGrid& grid, const DecodeTable& decode, const Span& x, const Span& y, std::uint32_t base,
                   float* result) {
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
void sample_cube(const TexelGrid& grid, const DecodeTable& decode, const Span& x, const Span& y, const Span& z,
                 std::uint32_t base, float* result) {
  std::array<float, max_components> far;
  const int components = Components ? Components : grid.components;
  sample_square<Components>(grid, decode, x, y, base + z.low, result);
  sample_square<Components>(grid, decode, x, y, base + z.high, far.data());
  for (int c = 0; c < components; ++c) result[c] += z.fraction * (far[c] - result[c]);
}

} // namespace

void sample(const TexelGrid& grid, const DecodeTable& decode, const float* position, float* result) {
  const Span x = span_at(grid, 0, position[0]), y = span_at(grid, 1, position[1]);
  if (grid.axes == 2) return sample_square<0>(grid, decode, x, y, 0, result);
  const Span z = span_at(grid, 2, position[2]);
  if (grid.axes == 3) {
    if (grid.components == 3) return sample_cube<3>(grid, decode, x, y, z, 0, result);
    return sample_cube<0>(grid, decode, x, y, z, 0, result);
  }
  const Span w = span_at(grid, 3, position[3]);
  std::array<float, max_components> far;
  sample_cube<0>(grid, decode, x, y, z, w.low, result);
  sample_cube<0>(grid, decode, x, y, z, w.high, far.data());
  for (int c = 0; c < grid.components; ++c) result[c] += w.fraction * (far[c] - result[c]);
}

} // namespace pith
