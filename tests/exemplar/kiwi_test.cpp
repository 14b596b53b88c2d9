// The kiwi exemplar: the same bytes always, seamless in x and z, whole seeds, the photographs' colours.
#include "volume/base/error.h"
#include "volume/base/image.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"
#include "volume/exemplar/kiwi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <queue>

namespace pith {
namespace {

/// 64-bit hash of all bytes, in order.
std::uint64_t hash_of_texels(const Exemplar& exemplar) {
  std::uint64_t h = 0;
  for (const std::uint8_t byte : exemplar.texel) h = mix_bits(h ^ byte);
  return h;
}

const Exemplar& kiwi_128() {
  static const Exemplar exemplar = procedural_exemplar("kiwi");
  return exemplar;
}

/// Linear light of every byte.
const std::array<double, 256>& linear_of_byte() {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> t{};
    for (int i = 0; i < 256; ++i) t[i] = linear_from_srgb(float(i) / 255.0f);
    return t;
  }();
  return table;
}

double luminance(const std::uint8_t* texel) {
  const auto& linear = linear_of_byte();
  return 0.2126 * linear[texel[0]] + 0.7152 * linear[texel[1]] + 0.0722 * linear[texel[2]];
}

/// Mean of the texels in linear light over rows [first, last] of depth, as sRGB bytes.
std::array<double, 3> mean_color(const Exemplar& e, int first, int last) {
  std::array<double, 3> sum{};
  for (int z = 0; z < e.size[2]; ++z)
    for (int y = first; y <= last; ++y)
      for (int x = 0; x < e.size[0]; ++x)
        for (int c = 0; c < 3; ++c) sum[c] += linear_of_byte()[e.at(x, y, z)[c]];
  const double count = double(e.size[0]) * e.size[2] * (last - first + 1);
  for (double& s : sum) s = 255.0 * srgb_from_linear(float(s / count));
  return sum;
}

TEST(Kiwi, HasTheShapeThatALapFillAsksFor) {
  const Exemplar& e = kiwi_128();
  EXPECT_NO_THROW(validate(e));
  EXPECT_EQ(e.axes, 3);
  EXPECT_EQ(e.size, (std::array<int, 4>{128, 128, 128, 1}));
  EXPECT_EQ(e.wrap[0], Wrap::repeat);
  EXPECT_EQ(e.wrap[1], Wrap::clamp);
  EXPECT_EQ(e.wrap[2], Wrap::repeat);
  ASSERT_EQ(e.channel.size(), 1u);
  EXPECT_EQ(e.channel[0], Channel{});
}

TEST(Kiwi, SameBytesWhateverTheThreads) {
  for (const int resolution : {16, 48, 96}) {
    LargeArray<std::uint8_t> bytes[2];
    for (const int threads : {1, 2}) {
      const ThreadLimit limit(threads);
      bytes[threads - 1] = procedural_exemplar("kiwi", {.resolution = resolution, .seed = 7}).texel;
    }
    EXPECT_EQ(bytes[0], bytes[1]) << resolution;
  }
}

TEST(Kiwi, GoldenBytes) {
  EXPECT_EQ(hash_of_texels(procedural_exemplar("kiwi", {.resolution = 64, .seed = 1})), 9617131484889467607ull);
  EXPECT_EQ(hash_of_texels(kiwi_128()), 1007638659596731062ull);
  EXPECT_NE(hash_of_texels(procedural_exemplar("kiwi", {.resolution = 64, .seed = 2})),
            hash_of_texels(procedural_exemplar("kiwi", {.resolution = 64, .seed = 1})));
}

TEST(Kiwi, NoSeamAcrossTheWrap) {
  // The mean step between neighbours across the wrap equals that between neighbours inside, for either periodic axis.
  const Exemplar& e = kiwi_128();
  const int n = e.size[0];
  for (const int axis : {0, 2}) {
    std::vector<double> step(n, 0.0);
    for (int i = 0; i < n; ++i)
      for (int y = 0; y < n; ++y)
        for (int j = 0; j < n; ++j) {
          const int next = (i + 1) % n;
          const std::uint8_t* a = axis == 0 ? e.at(i, y, j) : e.at(j, y, i);
          const std::uint8_t* b = axis == 0 ? e.at(next, y, j) : e.at(j, y, next);
          for (int c = 0; c < 3; ++c) step[i] += std::abs(int(a[c]) - int(b[c])) / (3.0 * n * n);
        }
    const double across = step[n - 1];
    std::sort(step.begin(), step.end() - 1);
    // Locules make the steps along x uneven by themselves; the seam must lie within the range that the inside has.
    EXPECT_GE(across, 0.9 * step.front()) << "axis " << axis;
    EXPECT_LE(across, 1.1 * step[n - 2]) << "axis " << axis;
  }
}

TEST(Kiwi, SeedsDoNotTouchAndStayInTheFlesh) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 99u}) {
    const std::vector<KiwiSeed> seeds = kiwi_seeds(seed);
    // Across the fruit a section shows about 57 seeds (photograph, with those that shine through); 13 locules a
    // width.
    EXPECT_GE(seeds.size(), 340u);
    EXPECT_LE(seeds.size(), 470u);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      const KiwiSeed& a = seeds[i];
      EXPECT_GT(kiwi_radius_at_depth(a.y - a.half_length), 0.30f);
      EXPECT_LT(kiwi_radius_at_depth(a.y - a.half_length), 0.60f); // photograph: 0.30 … 0.56 of the radius
      EXPECT_GT(kiwi_radius_at_depth(a.y + a.half_length), 0.26f); // outside the core
      for (std::size_t j = 0; j < i; ++j) {
        const KiwiSeed& b = seeds[j];
        const float dx = a.x - b.x - std::round(a.x - b.x), dz = a.z - b.z - std::round(a.z - b.z);
        const float across = a.half_width + b.half_width, along = a.half_length + b.half_length;
        const float d = (dx * dx + dz * dz) / (across * across) + (a.y - b.y) * (a.y - b.y) / (along * along);
        EXPECT_GT(d, 1.0f) << "seeds " << i << " and " << j << " of seed " << seed;
      }
    }
  }
}

TEST(Kiwi, SeedsAreWhole) {
  // Dark texels fall into as many pieces, under the periodic wrap, as there are seeds, each of its seed's volume.
  const Exemplar e = procedural_exemplar("kiwi", {.resolution = 192, .seed = 1});
  const int n = e.size[0];
  const auto index = [&](int x, int y, int z) { return (std::size_t(z) * n + y) * n + x; };
  std::vector<char> dark(e.texel_count(), 0);
  for (std::size_t i = 0; i < dark.size(); ++i) dark[i] = luminance(e.texel.data() + 3 * i) < 0.028;

  struct Piece {
    std::size_t texels = 0;
    int lowest_y = 1 << 20, highest_y = -1;
  };
  std::vector<int> label(dark.size(), -1);
  std::vector<Piece> pieces;
  for (std::size_t start = 0; start < dark.size(); ++start) {
    if (!dark[start] || label[start] >= 0) continue;
    Piece piece;
    std::queue<std::size_t> open({start});
    label[start] = int(pieces.size());
    while (!open.empty()) {
      const std::size_t at = open.front();
      open.pop();
      const int x = int(at % n), y = int(at / n % n), z = int(at / n / n);
      ++piece.texels;
      piece.lowest_y = std::min(piece.lowest_y, y);
      piece.highest_y = std::max(piece.highest_y, y);
      const auto visit = [&](int i, int j, int k) {
        if (j < 0 || j >= n) return;
        const std::size_t next = index((i + n) % n, j, (k + n) % n);
        if (dark[next] && label[next] < 0) label[next] = int(pieces.size()), open.push(next);
      };
      visit(x - 1, y, z), visit(x + 1, y, z), visit(x, y - 1, z), visit(x, y + 1, z), visit(x, y, z - 1),
          visit(x, y, z + 1);
    }
    pieces.push_back(piece);
  }

  const std::vector<KiwiSeed> seeds = kiwi_seeds(1);
  ASSERT_EQ(pieces.size(), seeds.size());
  std::vector<char> taken(pieces.size(), 0);
  for (const KiwiSeed& s : seeds) {
    const int found = label[index(int(s.x * n) % n, int(s.y * n), int(s.z * n) % n)];
    ASSERT_GE(found, 0) << "the centre of a seed is not dark";
    EXPECT_FALSE(taken[found]) << "two seeds run together";
    taken[found] = 1;
    EXPECT_GT(pieces[found].lowest_y, 0);
    EXPECT_LT(pieces[found].highest_y, n - 1);
    const double whole = 4.0 / 3.0 * 3.14159265 * s.half_length * s.half_width * s.half_width * double(n) * n * n;
    EXPECT_NEAR(double(pieces[found].texels) / whole, 1.0, 0.36); // the taper, and texels on the border
  }
}

TEST(Kiwi, ColorsOfThePhotographs) {
  // sRGB bytes. The bands were measured in photographs of a kiwi cut across (BSD-3, the Flutter sample Veggie
  // Seasons): mean colours of the section at parts of its radius, and the percentiles of its skin seen from outside.
  struct Band {
    const char* what;
    double radius_from, radius_to;
    std::array<double, 3> color;
    double tolerance;
  };
  const Band bands[] = {
      {"core", 0.05, 0.16, {218, 212, 167}, 10},
      {"edge of the core", 0.20, 0.26, {188, 184, 116}, 16},
      {"locules", 0.38, 0.48, {96, 93, 57}, 16},
      {"inner flesh", 0.58, 0.66, {128, 142, 46}, 10},
      {"middle of the flesh", 0.68, 0.78, {126, 141, 41}, 12},
      {"outer flesh", 0.84, 0.92, {114, 122, 30}, 14},
  };
  const Exemplar& e = kiwi_128();
  const int n = e.size[1];
  for (const Band& band : bands) {
    int first = n, last = -1;
    for (int y = 0; y < n; ++y) {
      const double radius = kiwi_radius_at_depth((float(y) + 0.5f) / n);
      if (radius >= band.radius_from && radius <= band.radius_to)
        first = std::min(first, y), last = std::max(last, y);
    }
    ASSERT_LE(first, last) << band.what;
    const std::array<double, 3> mean = mean_color(e, first, last);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(mean[c], band.color[c], band.tolerance) << band.what << ", component " << c;
  }
  // Skin from outside: darkest, median and brightest twentieth: (92, 50, 8), (135, 93, 48), (212, 166, 114).
  std::vector<std::pair<double, const std::uint8_t*>> skin;
  for (int z = 0; z < n; ++z)
    for (int x = 0; x < n; ++x) skin.push_back({luminance(e.at(x, 0, z)), e.at(x, 0, z)});
  std::sort(skin.begin(), skin.end());
  const std::uint8_t* median = skin[skin.size() / 2].second;
  EXPECT_NEAR(median[0], 135, 16);
  EXPECT_NEAR(median[1], 93, 16);
  EXPECT_NEAR(median[2], 48, 16);
  EXPECT_LT(skin[skin.size() / 20].second[1], 80);
  EXPECT_GT(skin[skin.size() * 19 / 20].second[1], 118);
}

TEST(Kiwi, LooksAlikeAtEveryResolution) {
  // Rows of equal depth have nearly the same mean colour, and the outermost row is skin.
  const Exemplar& fine = kiwi_128();
  for (const int n : {16, 32, 64, 100}) {
    const Exemplar coarse = procedural_exemplar("kiwi", {.resolution = n, .seed = 1});
    for (const double from : {0.25, 0.5, 0.75}) {
      const auto a = mean_color(coarse, int(from * n), int((from + 0.15) * n) - 1);
      const auto b = mean_color(fine, int(from * 128), int((from + 0.15) * 128) - 1);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 6.0) << n << " texels, depth " << from;
    }
    const auto skin = mean_color(coarse, 0, 0), expected = mean_color(fine, 0, 0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(skin[c], expected[c], 6.0) << n;
    EXPECT_GT(skin[0], skin[1] + 20) << "skin is brown";
  }
}

TEST(Kiwi, BadOptionsAreRefused) {
  EXPECT_THROW(procedural_exemplar("kiwi", {.resolution = 15}), InvalidInput);
  EXPECT_THROW(procedural_exemplar("kiwi", {.resolution = 513}), InvalidInput);
  EXPECT_THROW(procedural_exemplar("kumquat"), InvalidInput);
  const std::vector<std::string> names{"kiwi",
                                       "kiwi-flesh",
                                       "carrot",
                                       "tree",
                                       "watermelon",
                                       "watermelon-flesh",
                                       "watermelon-striped", // fruit and wood
                                       "tube",
                                       "sandstone",
                                       "shale",
                                       "limestone",
                                       "conglomerate",
                                       "sponge",
                                       "cream",
                                       "chocolate", // and stone, cake
                                       "mineral",
                                       "ripening",
                                       "brick",
                                       "pepper",
                                       "banana",
                                       "citrus", // and more
                                       "kiwi-seed",
                                       "watermelon-seed",
                                       "almond"};
  EXPECT_EQ(procedural_names(), names);
}

} // namespace
} // namespace pith
