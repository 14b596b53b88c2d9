// Volumes that do not repeat are made to: no seam, the same distribution of values, and untouched elsewhere.
#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"
#include "volume/exemplar/tile.h"
#include "volume/exemplar/tile_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pith {
namespace {

constexpr int n = 48;

/// Smooth noise that does not repeat: white noise under a box of 7 texels, three times, and a bent histogram.
Exemplar noise(bool two_values = false) {
  constexpr int margin = 10, m = n + 2 * margin;
  std::vector<float> field(m * m * m);
  for (std::size_t i = 0; i < field.size(); ++i) field[i] = static_cast<float>(uniform_of(hash_of(7, i)));
  const std::array<std::size_t, 3> stride{1, m, m * m};
  for (int pass = 0; pass < 9; ++pass) {
    std::vector<float> next(field.size());
    const std::size_t s = stride[pass % 3];
    for (std::size_t i = 3 * s; i + 3 * s < field.size(); ++i)
      for (int k = -3; k <= 3; ++k) next[i] += field[i + k * static_cast<std::ptrdiff_t>(s)] / 7;
    field.swap(next);
  }
  double mean = 0, squares = 0;
  std::vector<float> inside;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        inside.push_back(field[((z + margin) * m + y + margin) * m + x + margin]);
        mean += inside.back(), squares += inside.back() * inside.back();
      }
  mean /= double(inside.size());
  const double deviation = std::sqrt(squares / double(inside.size()) - mean * mean);
  Exemplar e;
  e.name = "noise";
  e.size = {n, n, n, 1};
  e.channel = {Channel{"value", Semantic::scalar, 1, false, 0, 1}};
  for (const float v : inside) {
    const double g = (v - mean) / deviation;
    e.texel.push_back(two_values
                          ? (g > 0.5 ? 220 : 30)
                          : static_cast<std::uint8_t>(std::clamp(std::lround(60 * std::exp(0.5 * g)), 0l, 255l)));
  }
  return e;
}

struct Moments {
  double mean = 0, deviation = 0;
};
template <class Takes>
Moments moments(const Exemplar& e, const Takes& takes) {
  double count = 0, sum = 0, squares = 0;
  for (int z = 0; z < e.size[2]; ++z)
    for (int y = 0; y < e.size[1]; ++y)
      for (int x = 0; x < e.size[0]; ++x) {
        if (!takes(x, y, z)) continue;
        const double v = e.at(x, y, z)[0];
        ++count, sum += v, squares += v * v;
      }
  return {sum / count, std::sqrt(squares / count - sum * sum / count / count)};
}
bool all(int, int, int) { return true; }

/// Mean step between texels i and i + 1 along an axis; the last is across the wrap.
std::vector<double> steps(const Exemplar& e, int axis) {
  std::vector<double> step(e.size[axis], 0.0);
  std::array<int, 3> p;
  for (p[2] = 0; p[2] < e.size[2]; ++p[2])
    for (p[1] = 0; p[1] < e.size[1]; ++p[1])
      for (p[0] = 0; p[0] < e.size[0]; ++p[0]) {
        std::array<int, 3> q = p;
        q[axis] = (p[axis] + 1) % e.size[axis];
        step[p[axis]] += std::abs(int(e.at(p[0], p[1], p[2])[0]) - int(e.at(q[0], q[1], q[2])[0]));
      }
  return step;
}

TEST(Tiled, RepeatsWithoutASeam) {
  const Exemplar before = noise();
  const std::vector<double> raw = steps(before, 0);
  EXPECT_GT(raw.back(), 2 * *std::max_element(raw.begin(), raw.end() - 1)) << "the noise repeats by itself";
  const Exemplar e = tiled(before);
  EXPECT_EQ(e.size, (std::array<int, 4>{36, 36, 36, 1}));
  EXPECT_NO_THROW(validate(e));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(e.wrap[axis], Wrap::repeat);
    std::vector<double> step = steps(e, axis);
    const double across = step.back();
    step.pop_back();
    EXPECT_LE(across, 1.1 * *std::max_element(step.begin(), step.end()));
    EXPECT_GE(across, 0.8 * *std::min_element(step.begin(), step.end()));
  }
}

TEST(Tiled, LeavesWhatIsNotBlendedAlone) {
  const Exemplar before = noise(), e = tiled(before);
  for (int z = 12; z < 36; ++z)
    for (int y = 12; y < 36; ++y)
      for (int x = 12; x < 36; ++x) ASSERT_EQ(e.at(x, y, z)[0], before.at(x, y, z)[0]);
}

TEST(Tiled, KeepsTheDistributionWhereItBlends) {
  const Exemplar before = noise(), e = tiled(before);
  const Moments whole = moments(before, all);
  const auto middle = [](int x, int y, int z) { // where two sources weigh about the same along some axis
    const auto half = [](int i) { return i >= 4 && i < 8; };
    return half(x) || half(y) || half(z);
  };
  const Moments blended = moments(e, middle);
  EXPECT_NEAR(blended.mean / whole.mean, 1, 0.1);
  EXPECT_NEAR(blended.deviation / whole.deviation, 1, 0.15); // a linear mean would have 0.71 and less
}

TEST(Tiled, KeepsTheSharesOfTwoValues) {
  const Exemplar before = noise(true), e = tiled(before);
  const double share = (moments(before, all).mean - 30) / 190, after = (moments(e, all).mean - 30) / 190;
  EXPECT_GT(share, 0.2);
  EXPECT_NEAR(after / share, 1, 0.12);
  // Nor does it become salt and pepper: few texels differ from all six neighbours.
  int lonely = 0;
  for (int z = 1; z < 35; ++z)
    for (int y = 1; y < 35; ++y)
      for (int x = 1; x < 35; ++x) {
        const int v = e.at(x, y, z)[0];
        EXPECT_TRUE(v == 30 || v == 220);
        lonely += e.at(x - 1, y, z)[0] != v && e.at(x + 1, y, z)[0] != v && e.at(x, y - 1, z)[0] != v &&
                  e.at(x, y + 1, z)[0] != v && e.at(x, y, z - 1)[0] != v && e.at(x, y, z + 1)[0] != v;
      }
  EXPECT_LT(lonely, 40); // of 39,304
}

TEST(Tiled, OnlyAlongTheAxesAskedFor) {
  const Exemplar before = noise(), e = tiled(before, {.axis = {true, false, true}, .border = 0.125});
  EXPECT_EQ(e.size, (std::array<int, 4>{42, 48, 42, 1}));
  EXPECT_EQ(e.wrap, (std::array<Wrap, 4>{Wrap::repeat, Wrap::clamp, Wrap::repeat, Wrap::clamp}));
  for (int y = 0; y < 48; ++y) EXPECT_EQ(e.at(20, y, 20)[0], before.at(20, y, 20)[0]);
}

TEST(Tiled, SameBytesWhateverTheThreads) {
  const Exemplar before = noise();
  decltype(Exemplar::texel) bytes[2];
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    bytes[threads - 1] = tiled(before).texel;
  }
  EXPECT_EQ(bytes[0], bytes[1]);
}

TEST(Tiled, RefusesWhatItCannotDo) {
  Exemplar e = noise();
  EXPECT_THROW(tiled(e, {.border = 0}), InvalidInput);
  EXPECT_THROW(tiled(e, {.border = 0.6}), InvalidInput);
  Exemplar flat = e;
  flat.axes = 2;
  flat.size = {n, n * n, 1, 1};
  EXPECT_THROW(tiled(flat), InvalidInput);
  EXPECT_NO_THROW(tiled(flat, {.axis = {true, true, false}}));
  e.channel = {Channel{"fibre", Semantic::direction, 3, false, -1, 1}};
  e.texel.resize(3 * e.texel_count());
  EXPECT_THROW(tiled(e), InvalidInput);
}

} // namespace
} // namespace pith
