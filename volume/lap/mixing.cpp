#include "volume/lap/mixing.h"

#include "volume/base/random.h"
#include "volume/layer/sample.h"

#include <algorithm>
#include <cmath>

namespace pith {

namespace {

/// Which texel a coordinate falls on.
int texel_at(const Exemplar& e, int axis, float u) {
  const int n = e.size[axis], i = static_cast<int>(std::floor(u * static_cast<float>(n)));
  return e.wrap[axis] == Wrap::repeat ? ((i % n) + n) % n : std::clamp(i, 0, n - 1);
}

/// Mean bytes over some axes: one row of components for each texel of the others.
class Means {
public:
  Means(const Exemplar& e, const std::array<bool, 4>& over) : e_(e), components_(e.component_count()) {
    std::size_t rows = 1;
    for (int a = 0; a < 3; ++a) {
      stride_[a] = over[a] ? 0 : rows;
      if (!over[a]) rows *= e.size[a];
    }
    sum_.assign(rows * components_, 0.0f);
    std::vector<float> count(rows, 0.0f);
    constexpr int step = 2; // every eighth texel says enough
    for (int z = 0; z < e.size[2]; z += over[2] ? step : 1)
      for (int y = 0; y < e.size[1]; y += over[1] ? step : 1)
        for (int x = 0; x < e.size[0]; x += over[0] ? step : 1) {
          const std::size_t row = row_of({x, y, z});
          const std::uint8_t* texel = e.at(x, y, z);
          for (int c = 0; c < components_; ++c) sum_[row * components_ + c] += texel[c];
          ++count[row];
        }
    for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] /= count[i / components_];
  }
  /// A texel's bytes less the mean.
  void deviation(const std::array<int, 3>& at, float* result) const {
    const std::uint8_t* texel = e_.at(at[0], at[1], at[2]);
    const float* mean = sum_.data() + row_of(at) * components_;
    for (int c = 0; c < components_; ++c) result[c] = texel[c] - mean[c];
  }

private:
  std::size_t row_of(const std::array<int, 3>& at) const {
    return at[0] * stride_[0] + at[1] * stride_[1] + at[2] * stride_[2];
  }
  const Exemplar& e_;
  int components_;
  std::array<std::size_t, 3> stride_{};
  std::vector<float> sum_;
};

} // namespace

float correlation_where_mixed(const Simplices& mesh, const Layer& layer) {
  constexpr std::size_t points = 20000;
  constexpr float well_seen = 0.2f;
  const Exemplar& e = layer.exemplar.front();
  const int components = e.component_count();
  const Means means(e, layer.blend.mean_over);
  std::vector<MaskGrid> grid(layer.mask.begin(), layer.mask.end());
  double together = 0, alone = 0;
  std::array<std::array<float, max_components>, 2> deviation;
  for (std::size_t k = 0; k < points; ++k) {
    const std::uint32_t s = static_cast<std::uint32_t>(k * mesh.count / points);
    Random random(hash_of(0x313, k));
    std::array<float, 4> b;
    float sum = 0;
    for (float& x : b) sum += x = static_cast<float>(-std::log(1 - random.uniform()));
    for (float& x : b) x /= sum;

    int seen = 0;
    float through = 1;
    for (std::uint32_t i = layer.begin[s + 1]; i-- > layer.begin[s] && seen < 2 && through > well_seen;) {
      const Lookup& lookup = layer.lookup[i];
      const Patch& patch = layer.patch[lookup.patch];
      Lanes w = all_lanes(0);
      for (int c = 0; c < 4; ++c) w += b[c] * lanes_at(layer.corner.data() + std::size_t(lookup.corner[c]) * 4);
      const float alpha = w[3] > 0 ? std::min(1.0f, w[3] * grid[patch.mask].alpha(w)) : 0.0f;
      if (through * alpha >= well_seen) {
        std::array<int, 3> at;
        for (int a = 0; a < 3; ++a) at[a] = texel_at(e, a, patch.frame.scale[a] * w[a] + patch.frame.offset[a]);
        means.deviation(at, deviation[seen++].data());
      }
      through *= 1 - alpha;
    }
    if (seen < 2) continue;
    for (int c = 0; c < components; ++c) {
      const double x = deviation[0][c], y = deviation[1][c];
      together += x * y;
      alone += 0.5 * (x * x + y * y);
    }
  }
  return alone > 0 ? static_cast<float>(std::clamp(together / alone, 0.0, 1.0)) : 0.0f;
}

} // namespace pith
