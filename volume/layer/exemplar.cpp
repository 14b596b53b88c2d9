#include "volume/layer/exemplar.h"

#include "volume/base/error.h"
#include "volume/base/image.h"
#include "volume/base/normal.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace pith {

int Exemplar::component_count() const {
  int count = 0;
  for (const Channel& c : channel) count += c.components;
  return count;
}

const std::uint8_t* Exemplar::at(int x, int y, int z, int w) const {
  const std::size_t texel_index = ((std::size_t(w) * size[2] + z) * size[1] + y) * size[0] + x;
  return texel.data() + texel_index * component_count();
}

std::uint8_t* Exemplar::at(int x, int y, int z, int w) {
  return const_cast<std::uint8_t*>(std::as_const(*this).at(x, y, z, w));
}

float decoded(const Channel& channel, std::uint8_t byte) {
  const float unit = byte / 255.0f;
  return channel.low + (channel.high - channel.low) * (channel.srgb ? linear_from_srgb(unit) : unit);
}

std::uint8_t encoded(const Channel& channel, float value) {
  const float unit = std::clamp((value - channel.low) / (channel.high - channel.low), 0.0f, 1.0f);
  return static_cast<std::uint8_t>(std::lround(255 * (channel.srgb ? srgb_from_linear(unit) : unit)));
}

void validate(const Exemplar& e) {
  const std::string where = "exemplar '" + e.name + "'";
  const auto refuse = [&](const std::string& what, const std::string& mend) {
    throw InvalidInput(where, what, mend);
  };
  if (e.axes < 2 || e.axes > 4) refuse("has " + std::to_string(e.axes) + " axes", "give 2, 3 or 4");
  for (int i = 0; i < 4; ++i)
    if (e.size[i] < 1 || e.size[i] > 8192 || (i >= e.axes && e.size[i] != 1))
      refuse("has size " + std::to_string(e.size[i]) + " along axis " + std::to_string(i),
             "give 1 to 8192 texels along each of its axes and 1 beyond");
  if (e.channel.empty()) refuse("has no channel", "give at least a colour");
  for (const Channel& c : e.channel) {
    const bool three =
        c.semantic == Semantic::color || c.semantic == Semantic::direction || c.semantic == Semantic::normal;
    if (c.components < 1 || (three && c.components != 3) || (c.semantic == Semantic::height && c.components != 1))
      refuse("channel '" + c.name + "' has " + std::to_string(c.components) + " components",
             "colours, directions and normals have 3, heights 1");
    if (!(c.low < c.high) || !std::isfinite(c.low) || !std::isfinite(c.high))
      refuse("channel '" + c.name + "' has an empty range", "give low < high");
  }
  if (e.component_count() > max_components)
    refuse("has " + std::to_string(e.component_count()) + " components",
           "use at most " + std::to_string(max_components));
  const std::size_t bytes = e.texel_count() * e.component_count();
  if (e.texel.size() != bytes)
    refuse("holds " + std::to_string(e.texel.size()) + " bytes of texels, its size needs " + std::to_string(bytes),
           "make size, channels and texels agree");
  if (!e.gaussian.empty() &&
      (e.gaussian.size() != bytes || e.inverse.size() != std::size_t(e.component_count()) * 256))
    refuse("has a Gaussian twin of another size", "make it anew with make_gaussian_twin");
}

void make_gaussian_twin(Exemplar& e) {
  const int components = e.component_count();
  const std::size_t count = e.texel_count();
  e.gaussian.assign(e.texel.size(), 0);
  e.inverse.assign(std::size_t(components) * 256, 0);
  constexpr double reach = 3; // standard deviations that a byte spans on either side
  const double tail = normal_cumulative(-reach);
  int component = 0;
  for (const Channel& channel : e.channel)
    for (int k = 0; k < channel.components; ++k, ++component) {
      std::vector<std::uint32_t> order(count);
      std::iota(order.begin(), order.end(), 0u);
      const auto value = [&](std::uint32_t i) { return e.texel[std::size_t(i) * components + component]; };
      std::stable_sort(order.begin(), order.end(), [&](auto i, auto j) { return value(i) < value(j); });
      for (std::size_t rank = 0; rank < count; ++rank) {
        const double p = tail + (1 - 2 * tail) * (rank + 0.5) / count;
        const double unit = normal_quantile(p) / (2 * reach) + 0.5;
        e.gaussian[std::size_t(order[rank]) * components + component] =
            static_cast<std::uint8_t>(std::clamp(std::lround(unit * 255), 0l, 255l));
      }
      for (int byte = 0; byte < 256; ++byte) {
        const double g = (byte / 255.0 - 0.5) * 2 * reach;
        const double p = (normal_cumulative(g) - tail) / (1 - 2 * tail);
        const std::size_t rank = std::min<std::size_t>(count - 1, static_cast<std::size_t>(std::max(0.0, p) * count));
        e.inverse[std::size_t(component) * 256 + byte] = decoded(channel, value(order[rank]));
      }
    }
}

Exemplar half_size(const Exemplar& fine) {
  Exemplar coarse;
  coarse.name = fine.name;
  coarse.axes = fine.axes;
  coarse.wrap = fine.wrap;
  coarse.channel = fine.channel;
  for (int i = 0; i < 4; ++i) coarse.size[i] = std::max(1, fine.size[i] / 2);
  const int components = fine.component_count();
  coarse.texel.resize(coarse.texel_count() * components);
  const bool twin = !fine.gaussian.empty();
  if (twin) coarse.gaussian.resize(coarse.texel.size());
  coarse.inverse = fine.inverse;

  std::vector<std::array<float, 256>> decode(components);
  std::vector<const Channel*> channel_of(components);
  for (int c = 0, k = 0; k < static_cast<int>(fine.channel.size()); ++k)
    for (int i = 0; i < fine.channel[k].components; ++i, ++c) {
      channel_of[c] = &fine.channel[k];
      for (int b = 0; b < 256; ++b) decode[c][b] = decoded(fine.channel[k], static_cast<std::uint8_t>(b));
    }
  // Each coarse texel averages the fine texels of its box (two along an axis, three at an odd end).
  const auto range = [&](int axis, int i) {
    const int begin = i * fine.size[axis] / coarse.size[axis], end = (i + 1) * fine.size[axis] / coarse.size[axis];
    return std::pair(begin, std::max(end, begin + 1));
  };
  std::size_t out = 0;
  for (int w = 0; w < coarse.size[3]; ++w)
    for (int z = 0; z < coarse.size[2]; ++z)
      for (int y = 0; y < coarse.size[1]; ++y)
        for (int x = 0; x < coarse.size[0]; ++x) {
          std::array<float, max_components> sum{}, twin_sum{};
          int count = 0;
          const auto [w0, w1] = range(3, w);
          const auto [z0, z1] = range(2, z);
          const auto [y0, y1] = range(1, y);
          const auto [x0, x1] = range(0, x);
          for (int fw = w0; fw < w1; ++fw)
            for (int fz = z0; fz < z1; ++fz)
              for (int fy = y0; fy < y1; ++fy)
                for (int fx = x0; fx < x1; ++fx, ++count) {
                  const std::uint8_t* texel = fine.at(fx, fy, fz, fw);
                  for (int c = 0; c < components; ++c) sum[c] += decode[c][texel[c]];
                  if (twin)
                    for (int c = 0; c < components; ++c) twin_sum[c] += fine.gaussian[texel - fine.texel.data() + c];
                }
          for (int c = 0; c < components; ++c, ++out) {
            coarse.texel[out] = encoded(*channel_of[c], sum[c] / count);
            if (twin) coarse.gaussian[out] = static_cast<std::uint8_t>(std::lround(twin_sum[c] / count));
          }
        }
  return coarse;
}

} // namespace pith
