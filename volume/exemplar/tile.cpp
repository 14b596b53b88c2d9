#include "volume/exemplar/tile.h"

#include "volume/base/error.h"
#include "volume/base/normal.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace pith {

namespace {

constexpr std::uint64_t stage = 0x711e; // of random numbers
constexpr int mean_reach = 3;           // texels: of the means that order texels of one value

using Size = std::array<int, 3>;

/// Calls body(first, stride, n) for every line of texels along an axis.
template <class Body>
void each_line(const Size& size, int axis, const Body& body) {
  const std::array<std::size_t, 3> stride{1, std::size_t(size[0]), std::size_t(size[0]) * size[1]};
  const int b = axis == 0 ? 1 : 0, c = axis == 2 ? 1 : 2;
  parallel_for(size[c], 1, [&](std::size_t k) {
    for (int j = 0; j < size[b]; ++j) body(k * stride[c] + j * stride[b], stride[axis], size[axis]);
  });
}

/// The mean over a box of 2 · mean_reach + 1 texels along each axis, smaller at the ends.
void average(std::vector<float>& field, const Size& size) {
  for (int axis = 0; axis < 3; ++axis)
    each_line(size, axis, [&](std::size_t first, std::size_t stride, int n) {
      std::vector<double> up_to(n + 1, 0.0);
      for (int i = 0; i < n; ++i) up_to[i + 1] = up_to[i] + field[first + i * stride];
      for (int i = 0; i < n; ++i) {
        const int low = std::max(0, i - mean_reach), high = std::min(n, i + mean_reach + 1);
        field[first + i * stride] = static_cast<float>((up_to[high] - up_to[low]) / (high - low));
      }
    });
}

/// A component as a standard normal field, and its bytes in order.
struct Gaussian {
  std::vector<double> value;
  std::vector<std::uint8_t> sorted;

  std::uint8_t byte_of(double g) const {
    const double rank = normal_cumulative(g) * static_cast<double>(sorted.size());
    return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(std::max(0.0, rank)))];
  }
};

Gaussian gaussian_of(const Exemplar& e, const Size& size, int component) {
  const std::size_t count = e.texel_count(), components = e.component_count();
  std::vector<float> around(count);
  for (std::size_t i = 0; i < count; ++i) around[i] = e.texel[i * components + component];
  average(around, size);
  struct Entry {
    std::uint8_t byte;
    float mean;
    std::uint64_t chance;
    std::uint32_t index;
  };
  std::vector<Entry> order(count);
  for (std::uint32_t i = 0; i < count; ++i)
    order[i] = {e.texel[i * components + component], around[i], hash_of(stage, i), i};
  std::sort(order.begin(), order.end(), [](const Entry& a, const Entry& b) {
    if (a.byte != b.byte) return a.byte < b.byte;
    if (a.mean != b.mean) return a.mean < b.mean;
    return a.chance != b.chance ? a.chance < b.chance : a.index < b.index;
  });
  Gaussian g;
  g.value.resize(count);
  g.sorted.resize(count);
  for (std::size_t rank = 0; rank < count; ++rank) {
    g.value[order[rank].index] = normal_quantile((static_cast<double>(rank) + 0.5) / static_cast<double>(count));
    g.sorted[rank] = order[rank].byte;
  }
  return g;
}

void check(const Exemplar& e, const TileOptions& options, const std::string& where) {
  validate(e);
  if (!(options.border > 0) || options.border > 0.5)
    throw InvalidInput(where + "/border", "is " + std::to_string(options.border) + ", must be above 0, to 0.5",
                       "give a part of the exemplar");
  if (e.axes > 3) throw InvalidInput(where, "has a fourth axis", "tile images and volumes");
  for (int axis = 0; axis < 3; ++axis) {
    if (!options.axis[axis]) continue;
    if (axis >= e.axes) throw InvalidInput(where, "has no axis " + std::to_string(axis), "leave that axis out");
    if (e.size[axis] < 4)
      throw InvalidInput(where, "has " + std::to_string(e.size[axis]) + " texels along axis " + std::to_string(axis),
                         "give four or more");
  }
  for (const Channel& c : e.channel)
    if (c.semantic == Semantic::direction || c.semantic == Semantic::normal)
      throw InvalidInput(where, "has the channel '" + c.name + "' of directions, which cannot be blended",
                         "remove the channel, or give an exemplar that repeats already");
}

} // namespace

Exemplar tiled(const Exemplar& exemplar, const TileOptions& options, const std::string& where) {
  check(exemplar, options, where);
  const Size from{exemplar.size[0], exemplar.size[1], exemplar.size[2]};
  Exemplar result;
  result.name = exemplar.name;
  result.axes = exemplar.axes;
  result.wrap = exemplar.wrap;
  result.channel = exemplar.channel;
  Size to = from, blended{};
  for (int axis = 0; axis < 3; ++axis) {
    if (options.axis[axis]) {
      blended[axis] = std::max(1, static_cast<int>(std::lround(options.border * from[axis])));
      to[axis] = from[axis] - blended[axis];
      result.wrap[axis] = Wrap::repeat;
    }
    result.size[axis] = to[axis];
  }
  const std::size_t components = exemplar.component_count();
  result.texel.resize(result.texel_count() * components);

  for (std::size_t component = 0; component < components; ++component) {
    const Gaussian g = gaussian_of(exemplar, from, static_cast<int>(component));
    parallel_for(to[2], 1, [&](std::size_t z) {
      Size p;
      p[2] = static_cast<int>(z);
      for (p[1] = 0; p[1] < to[1]; ++p[1])
        for (p[0] = 0; p[0] < to[0]; ++p[0]) {
          // Along each axis near its beginning: here, and as far beyond the end; sine and cosine keep the variance.
          std::array<std::array<int, 2>, 3> place;
          std::array<std::array<double, 2>, 3> weight;
          std::array<int, 3> sources;
          for (int axis = 0; axis < 3; ++axis) {
            place[axis] = {p[axis], p[axis] + to[axis]};
            const double t = 0.5 * std::numbers::pi * (p[axis] + 0.5) / std::max(1, blended[axis]);
            sources[axis] = p[axis] < blended[axis] ? 2 : 1;
            weight[axis] = sources[axis] == 2 ? std::array{std::sin(t), std::cos(t)} : std::array{1.0, 0.0};
          }
          const auto index = [&](int i, int j, int k) {
            return (std::size_t(place[2][k]) * from[1] + place[1][j]) * from[0] + place[0][i];
          };
          std::uint8_t& byte = result.texel[((z * to[1] + p[1]) * to[0] + p[0]) * components + component];
          if (sources[0] * sources[1] * sources[2] == 1) {
            byte = exemplar.texel[index(0, 0, 0) * components + component];
            continue;
          }
          double sum = 0;
          for (int k = 0; k < sources[2]; ++k)
            for (int j = 0; j < sources[1]; ++j)
              for (int i = 0; i < sources[0]; ++i)
                sum += weight[0][i] * weight[1][j] * weight[2][k] * g.value[index(i, j, k)];
          byte = g.byte_of(sum);
        }
    });
  }
  return result;
}

} // namespace pith
