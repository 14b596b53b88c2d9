#include "volume/layer/sample.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace pith {

TexelGrid texel_grid(const Exemplar& exemplar, std::span<const std::uint8_t> texels, const DecodeTable& decode) {
  TexelGrid grid;
  grid.axes = exemplar.axes;
  grid.components = exemplar.component_count();
  std::vector<std::array<std::uint16_t, 256>> fine(grid.components);
  for (int c = 0; c < grid.components; ++c) {
    const auto [least, largest] = std::minmax_element(decode[c].begin(), decode[c].end());
    const float range = *largest - *least;
    grid.low[c / 4][c % 4] = *least;
    grid.step[c / 4][c % 4] = range / 65535;
    for (int byte = 0; byte < 256; ++byte)
      fine[c][byte] =
          range > 0 ? static_cast<std::uint16_t>(std::lrint((decode[c][byte] - *least) / range * 65535.0)) : 0;
  }
  grid.texel.resize(exemplar.texel_count() * grid.components + 3);
  parallel_for(exemplar.texel_count(), 1 << 16, [&](std::size_t i) {
    for (int c = 0; c < grid.components; ++c)
      grid.texel[i * grid.components + c] = fine[c][texels[i * grid.components + c]];
  });
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
    grid.any_mirror |= exemplar.wrap[axis] == Wrap::mirror;
  }
  return grid;
}

TexelGrid mean_grid(const TexelGrid& grid, const std::array<bool, 4>& over) {
  TexelGrid mean = grid;
  std::uint32_t stride = grid.components;
  for (int axis = 0; axis < 4; ++axis) {
    if (over[axis]) {
      mean.texels[axis] = 1;
      mean.count[axis] = 1;
      mean.before[axis] = mean.behind[axis] = 0;
    }
    mean.stride[axis] = static_cast<std::int32_t>(stride);
    stride *= mean.count[axis];
  }
  std::vector<double> sum(stride, 0.0);
  std::array<int, 4> at{};
  const auto kept = [&](int axis) { return over[axis] ? 0u : std::uint32_t(at[axis]) * mean.stride[axis]; };
  const std::uint16_t* texel = grid.texel.data();
  for (at[3] = 0; at[3] < grid.count[3]; ++at[3])
    for (at[2] = 0; at[2] < grid.count[2]; ++at[2])
      for (at[1] = 0; at[1] < grid.count[1]; ++at[1])
        for (at[0] = 0; at[0] < grid.count[0]; ++at[0], texel += grid.components) {
          double* row = sum.data() + kept(0) + kept(1) + kept(2) + kept(3);
          for (int c = 0; c < grid.components; ++c) row[c] += texel[c];
        }
  const double share = static_cast<double>(stride) / static_cast<double>(grid.texel.size() - 3);
  mean.texel.resize(stride + 3);
  for (std::uint32_t i = 0; i < stride; ++i) mean.texel[i] = static_cast<std::uint16_t>(std::lrint(sum[i] * share));
  return mean;
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
