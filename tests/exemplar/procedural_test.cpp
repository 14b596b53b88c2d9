// What all procedural exemplars have in common: the same bytes always, no seam where they repeat, alike at every
// resolution; and what each is for: layers at their depths, grain in its direction, channels with their meaning.
#include "volume/base/error.h"
#include "volume/base/image.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"
#include "volume/exemplar/procedural.h"
#include "volume/exemplar/tile_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace pith {
namespace {

const Exemplar& exemplar_of(const std::string& name, int resolution = 32) {
  static std::map<std::pair<std::string, int>, Exemplar> made;
  auto& one = made[{name, resolution}];
  if (one.texel.empty()) one = procedural_exemplar(name, {.resolution = resolution});
  return one;
}

/// Mean over texels of the first channel, decoded to linear light, between parts [from, to) of the y axis.
std::array<double, 3> mean_color(const Exemplar& e, double from = 0, double to = 1) {
  std::array<double, 3> sum{};
  double count = 0;
  for (int z = 0; z < e.size[2]; ++z)
    for (int y = int(from * e.size[1]); y < int(to * e.size[1]); ++y)
      for (int x = 0; x < e.size[0]; ++x, ++count)
        for (int c = 0; c < 3; ++c) sum[c] += linear_from_srgb(float(e.at(x, y, z)[c]) / 255.0f);
  for (double& s : sum) s /= count;
  return sum;
}

/// Mean step of the bytes between texels i and i + 1 along an axis, for every i; the last is across the wrap.
std::vector<double> steps_along(const Exemplar& e, int axis) {
  const int n = e.size[axis], components = e.component_count();
  std::vector<double> step(n, 0.0);
  std::array<int, 3> p;
  for (p[2] = 0; p[2] < e.size[2]; ++p[2])
    for (p[1] = 0; p[1] < e.size[1]; ++p[1])
      for (p[0] = 0; p[0] < e.size[0]; ++p[0]) {
        std::array<int, 3> q = p;
        q[axis] = (p[axis] + 1) % n;
        const std::uint8_t *a = e.at(p[0], p[1], p[2]), *b = e.at(q[0], q[1], q[2]);
        for (int c = 0; c < components; ++c) step[p[axis]] += std::abs(int(a[c]) - int(b[c]));
      }
  for (double& s : step) s /= double(e.texel_count()) / n * components;
  return step;
}

double mean_step(const Exemplar& e, int axis) {
  const std::vector<double> step = steps_along(e, axis);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < step.size(); ++i) sum += step[i];
  return sum / double(step.size() - 1);
}

class Procedural : public ::testing::TestWithParam<std::string> {};

TEST_P(Procedural, IsWellFormed) {
  const Exemplar& e = exemplar_of(GetParam());
  EXPECT_NO_THROW(validate(e));
  EXPECT_EQ(e.name, GetParam());
  EXPECT_EQ(e.axes, 3);
  EXPECT_EQ(e.size, (std::array<int, 4>{32, 32, 32, 1}));
  EXPECT_EQ(e.channel.front(), Channel{});
}

TEST_P(Procedural, SameBytesWhateverTheThreads) {
  decltype(Exemplar::texel) bytes[2];
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    bytes[threads - 1] = procedural_exemplar(GetParam(), {.resolution = 20, .seed = 7}).texel;
  }
  EXPECT_EQ(bytes[0], bytes[1]);
  EXPECT_NE(bytes[0], procedural_exemplar(GetParam(), {.resolution = 20, .seed = 8}).texel);
}

TEST_P(Procedural, NoSeamAcrossTheWrap) {
  const Exemplar& e = exemplar_of(GetParam());
  for (int axis = 0; axis < 3; ++axis) {
    if (e.wrap[axis] != Wrap::repeat) continue;
    std::vector<double> step = steps_along(e, axis);
    const double across = step.back();
    step.pop_back();
    std::sort(step.begin(), step.end());
    EXPECT_LE(across, 1.05 * step.back()) << "axis " << axis;
    EXPECT_GE(across, 0.8 * step.front()) << "axis " << axis;
  }
}

TEST_P(Procedural, LooksAlikeAtEveryResolution) {
  const std::array<double, 3> fine = mean_color(exemplar_of(GetParam()));
  for (const int resolution : {16, 21}) {
    const std::array<double, 3> coarse = mean_color(exemplar_of(GetParam(), resolution));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(srgb_from_linear(float(coarse[c])), srgb_from_linear(float(fine[c])), 0.07) << resolution;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Procedural, ::testing::ValuesIn(procedural_names()), [](const auto& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(ProceduralTypes, RepeatAlongTheAxesThatTheirTypeLeavesFree) {
  const auto repeats = [](const char* name) {
    const Exemplar& e = exemplar_of(name, 16);
    std::string axes;
    for (int a = 0; a < 3; ++a) axes += e.wrap[a] == Wrap::repeat ? 'r' : 'c';
    return axes;
  };
  for (const char* name :
       {"sponge", "cream", "chocolate", "limestone", "conglomerate", "sandstone", "shale", "tube", "brick"})
    EXPECT_EQ(repeats(name), "rrr") << name;
  for (const char* name : {"kiwi", "kiwi-flesh", "carrot", "tree", "watermelon", "watermelon-flesh",
                           "watermelon-striped", "pepper", "banana", "citrus"})
    EXPECT_EQ(repeats(name), "rcr") << name;
  EXPECT_EQ(repeats("mineral"), "rcc");
  for (const char* name : {"ripening", "kiwi-seed", "watermelon-seed", "almond"})
    EXPECT_EQ(repeats(name), "ccc") << name;
}

TEST(ProceduralTypes, ThoseWithoutDirectionAreAlikeAlongEveryAxis) {
  for (const char* name : {"sponge", "cream", "chocolate", "conglomerate"}) {
    const Exemplar& e = exemplar_of(name);
    const double x = mean_step(e, 0), y = mean_step(e, 1), z = mean_step(e, 2);
    EXPECT_NEAR(y / x, 1, 0.25) << name;
    EXPECT_NEAR(z / x, 1, 0.25) << name;
  }
  const Exemplar& melon = exemplar_of("watermelon"); // type 1-b: alike across the depth
  EXPECT_NEAR(mean_step(melon, 0) / mean_step(melon, 2), 1, 0.15);
}

TEST(ProceduralTypes, GrainRunsWhereTheTypeSays) {
  for (const char* name : {"tube", "tree", "carrot", "banana"}) // fibres along T
    EXPECT_GT(mean_step(exemplar_of(name), 0), 1.25 * mean_step(exemplar_of(name), 2)) << name;
  EXPECT_GT(mean_step(exemplar_of("watermelon-striped"), 0), 1.25 * mean_step(exemplar_of("watermelon-striped"), 2));
  for (const char* name : {"sandstone", "shale"}) { // layers across S
    EXPECT_GT(mean_step(exemplar_of(name), 1), 1.25 * mean_step(exemplar_of(name), 0)) << name;
    EXPECT_GT(mean_step(exemplar_of(name), 1), 1.25 * mean_step(exemplar_of(name), 2)) << name;
  }
}

TEST(ProceduralLayers, LieAtTheirDepths) {
  // Depth is 1 − radius². Linear light.
  const auto at = [](const char* name, double outer_radius, double inner_radius) {
    return mean_color(exemplar_of(name, 48), 1 - outer_radius * outer_radius, 1 - inner_radius * inner_radius);
  };
  const auto phloem = at("carrot", 0.9, 0.6), xylem = at("carrot", 0.38, 0.2);
  EXPECT_GT(xylem[1], 1.5 * phloem[1]) << "a carrot's core is yellower";
  const auto rind = at("watermelon", 0.95, 0.92), flesh = at("watermelon", 0.7, 0.4),
             skin = at("watermelon", 1, 0.9895);
  EXPECT_GT(skin[1], 1.5 * skin[0]) << "a watermelon's skin is green";
  EXPECT_GT(rind[1], 0.7 * rind[0]) << "its rind is pale";
  EXPECT_GT(flesh[0], 4 * flesh[1]) << "its flesh is red";
  const auto bark = at("tree", 1, 0.96), wood = at("tree", 0.9, 0.5);
  EXPECT_GT(wood[1], 3 * bark[1]) << "bark is darker than wood";
  const auto pith = at("citrus", 0.935, 0.90), pulp = at("citrus", 0.8, 0.4);
  EXPECT_GT(pith[2], 4 * pulp[2]) << "an orange's pith is white";
  const auto wall = at("pepper", 0.95, 0.8), hollow = at("pepper", 0.6, 0.3);
  EXPECT_GT(hollow[2], 4 * wall[2]) << "a pepper's inside is pale";
}

TEST(ProceduralLayers, TheMineralChangesAlongItsAxisAndTheFruitFromItsSunnySide) {
  const auto mean_at = [](const Exemplar& e, int axis, int from, int to, int y0, int y1) {
    std::array<double, 3> sum{};
    for (int k = 0; k < e.size[2]; ++k)
      for (int j = y0; j < y1; ++j)
        for (int i = 0; i < e.size[0]; ++i) {
          const int at = axis == 0 ? i : k;
          if (at < from || at >= to) continue;
          for (int c = 0; c < 3; ++c) sum[c] += linear_from_srgb(float(e.at(i, j, k)[c]) / 255.0f);
        }
    return sum;
  };
  const Exemplar& mineral = exemplar_of("mineral");
  const auto foot = mean_at(mineral, 2, 0, 6, 23, 30), tip = mean_at(mineral, 2, 27, 32, 23, 30);
  EXPECT_GT(foot[0], 2 * foot[2]) << "pink";
  EXPECT_GT(tip[2], 2 * tip[0]) << "blue";
  const Exemplar& peach = exemplar_of("ripening");
  const auto shade = mean_at(peach, 0, 0, 6, 0, 1), sun = mean_at(peach, 0, 26, 32, 0, 1);
  EXPECT_GT(shade[1], shade[0] * 0.9) << "green";
  EXPECT_GT(sun[0], 4 * sun[1]) << "red";
}

TEST(ProceduralChannels, AlphaHoldsAWholeThing) {
  for (const char* name : {"kiwi-seed", "watermelon-seed", "almond"}) {
    const Exemplar& e = exemplar_of(name);
    ASSERT_EQ(e.channel.size(), 2u) << name;
    EXPECT_EQ(e.channel[1].name, "alpha");
    EXPECT_EQ(e.channel[1].semantic, Semantic::scalar);
    EXPECT_FALSE(e.channel[1].srgb);
    const int n = e.size[0];
    EXPECT_EQ(e.at(n / 2, n / 2, n / 2)[3], 255) << name;
    double volume = 0;
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
          const int alpha = e.at(x, y, z)[3];
          volume += alpha / 255.0;
          if (std::min({x, y, z}) == 0 || std::max({x, y, z}) == n - 1) {
            ASSERT_LE(alpha, 8) << name << " reaches its cube's face";
          }
        }
    EXPECT_GT(volume / (double(n) * n * n), 0.02) << name;
    EXPECT_LT(volume / (double(n) * n * n), 0.25) << name;
  }
}

TEST(ProceduralLayers, AWatermelonsStripesRunFromEndToEnd) {
  // On the skin some lines along T are nearly all dark, others have next to nothing dark: one stripe in the width.
  const Exemplar& e = exemplar_of("watermelon-striped", 64);
  std::vector<double> dark(64, 0.0);
  for (int z = 0; z < 64; ++z)
    for (int x = 0; x < 64; ++x) dark[x] += e.at(x, 0, z)[1] < 110 ? 1.0 / 64 : 0.0;
  const auto [least, most] = std::minmax_element(dark.begin(), dark.end());
  EXPECT_GT(*most, 0.8);
  EXPECT_LT(*least, 0.2);
  int borders = 0;
  for (int x = 0; x < 64; ++x) borders += (dark[x] > 0.5) != (dark[(x + 1) % 64] > 0.5);
  EXPECT_EQ(borders, 2);
  const auto at = [&](double outer, double inner) { return mean_color(e, 1 - outer * outer, 1 - inner * inner); };
  const auto rind = at(0.95, 0.92), flesh = at(0.7, 0.4), core = at(0.12, 0);
  EXPECT_GT(rind[1], 0.8 * rind[0]) << "its rind is pale";
  EXPECT_GT(flesh[0], 4 * flesh[1]) << "its flesh is red";
  EXPECT_GT(core[1], 1.3 * flesh[1]) << "and paler in the middle";
}

TEST(ProceduralChannels, FleshWithoutSeedsIsTheFleshBetweenSeeds) {
  for (const auto& [with, without] : {std::pair("kiwi", "kiwi-flesh"), std::pair("watermelon", "watermelon-flesh")}) {
    const Exemplar &a = exemplar_of(with), &b = exemplar_of(without);
    std::size_t same = 0, darker = 0, dark_a = 0, dark_b = 0;
    for (std::size_t i = 0; i < a.texel.size(); i += 3) {
      same += std::equal(a.texel.begin() + i, a.texel.begin() + i + 3, b.texel.begin() + i);
      darker += a.texel[i] < b.texel[i];
      const std::size_t row = i / 3 / 32 % 32;
      if (row < 6) continue; // skin may be dark
      dark_a += a.texel[i] + a.texel[i + 1] + a.texel[i + 2] < 130;
      dark_b += b.texel[i] + b.texel[i + 1] + b.texel[i + 2] < 130;
    }
    if (std::string(with) == "watermelon") { // a kiwi's flesh has colours of its own
      EXPECT_GT(same, a.texel_count() / 3);
      EXPECT_GT(darker, 20u);
    }
    EXPECT_GT(dark_a, 50u) << with << " has seeds";
    EXPECT_LT(dark_b, dark_a / 20) << without << " has none";
  }
}

TEST(ProceduralChannels, TubeHasUnitFibersAlongItsAxis) {
  const Exemplar& e = exemplar_of("tube", 128);
  ASSERT_EQ(e.channel.size(), 3u);
  EXPECT_EQ(e.channel[1].name, "extinction");
  EXPECT_EQ(e.channel[2].semantic, Semantic::direction);
  double least = 2, most = 0, along = 0;
  for (std::size_t i = 0; i < e.texel_count(); ++i) {
    double squared = 0;
    for (int c = 0; c < 3; ++c) squared += std::pow(decoded(e.channel[2], e.texel[7 * i + 4 + c]), 2);
    least = std::min(least, squared);
    most = std::max(most, squared);
    along += decoded(e.channel[2], e.texel[7 * i + 6]);
  }
  EXPECT_GT(std::sqrt(least), 0.98);
  EXPECT_LT(std::sqrt(most), 1.02);
  EXPECT_GT(along / double(e.texel_count()), 0.97);
  // Along the fibre the colour changes less than straight along z: the direction is that of what is seen.
  double along_fiber = 0, straight = 0;
  const int n = e.size[0], far = 20;
  const auto red = [&](double x, double y, int z) { // bilinear
    const int i = int(std::floor(x)), j = int(std::floor(y));
    const double u = x - i, v = y - j;
    const auto texel = [&](int a, int b) { return double(e.at((a + n) % n, (b + n) % n, z)[1]); };
    return (1 - v) * ((1 - u) * texel(i, j) + u * texel(i + 1, j)) +
           v * ((1 - u) * texel(i, j + 1) + u * texel(i + 1, j + 1));
  };
  for (int z = 0; z + far < n; z += 8)
    for (int y = 0; y < n; y += 3)
      for (int x = 0; x < n; x += 3) {
        double a = x, b = y; // walk in short steps
        for (int k = 0; k < far; ++k) {
          const std::uint8_t* here = e.at((int(std::lround(a)) + n) % n, (int(std::lround(b)) + n) % n, z + k);
          const double rise = decoded(e.channel[2], here[6]);
          a += decoded(e.channel[2], here[4]) / rise;
          b += decoded(e.channel[2], here[5]) / rise;
        }
        along_fiber += std::fabs(red(x, y, z) - red(a, b, z + far));
        straight += std::fabs(red(x, y, z) - red(x, y, z + far));
      }
  EXPECT_LT(along_fiber, 0.85 * straight);
}

TEST(ProceduralChannels, HeightsAreInMillimetres) {
  for (const char* name : {"tree", "brick"}) {
    const Exemplar& e = exemplar_of(name);
    ASSERT_EQ(e.channel.size(), 2u) << name;
    EXPECT_EQ(e.channel[1].semantic, Semantic::height);
    float least = 1e9f, most = -1e9f;
    for (int z = 0; z < 32; ++z)
      for (int x = 0; x < 32; ++x) {
        least = std::min(least, decoded(e.channel[1], e.at(x, 0, z)[3]));
        most = std::max(most, decoded(e.channel[1], e.at(x, 0, z)[3]));
      }
    EXPECT_GT(most - least, 2.0f) << name;
    EXPECT_LT(most - least, 6.0f) << name;
  }
}

TEST(TileNoise, RepeatsWhereItShouldAndStaysInRange) {
  const TileNoise noise(5, {4, 3, 6}, tile_around);
  for (int i = 0; i < 500; ++i) {
    Random random(1, i);
    const float x = float(random.uniform()), y = float(random.uniform()), z = float(random.uniform());
    EXPECT_NEAR(noise(x, y, z), noise(x + 1, y, z - 2), 1e-4f);
    EXPECT_LE(std::fabs(noise(x, y, z)), 1.0f);
    EXPECT_EQ(noise(x, 1.0f, z), noise(x, 1.7f, z));
    EXPECT_NEAR(noise(x, y, z), noise(x + 1e-4f, y + 1e-4f, z + 1e-4f), 0.01f);
  }
}

TEST(TileNoise, NearestPointsAreTheNearest) {
  const ScatteredPoints points(9, {5, 5, 5}, 0.4f);
  for (int i = 0; i < 200; ++i) {
    Random random(2, i);
    const float x = float(random.uniform()), y = float(random.uniform()), z = float(random.uniform());
    const auto a = points.nearest(x, y, z), b = points.nearest(x + 1, y - 1, z + 3);
    EXPECT_EQ(a.hash, b.hash);
    EXPECT_NEAR(a.first, b.first, 1e-4f);
    EXPECT_LE(a.first, a.second);
    float least = 1e9f;
    points.near(x, y, z, [&](const Point3f& d, std::uint64_t) {
      least = std::min(least, 5 * std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
    });
    EXPECT_NEAR(a.first, least, 1e-5f);
  }
}

} // namespace
} // namespace pith
