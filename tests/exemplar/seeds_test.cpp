// Seeds as things: whole in their cube, of one piece, pointed towards the core, dark; and flesh without seeds.
#include "volume/base/image.h"
#include "volume/exemplar/procedural.h"

#include <gtest/gtest.h>

namespace pith {
namespace {

class Seeds : public ::testing::TestWithParam<const char*> {};

TEST_P(Seeds, AreWholeAndPointToTheCore) {
  const Exemplar e = procedural_exemplar(GetParam(), {.resolution = 48});
  ASSERT_EQ(e.channel.size(), 2u);
  EXPECT_EQ(e.channel[1].name, "alpha");
  const int n = 48;
  std::array<int, 48> width{};
  double dark = 0, opaque = 0;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const std::uint8_t* texel = e.at(x, y, z);
        if (std::min({x, y, z}) == 0 || std::max({x, y, z}) == n - 1) {
          ASSERT_EQ(texel[3], 0) << x << y << z;
        }
        if (texel[3] < 128) continue;
        ++width[y];
        ++opaque;
        dark += linear_from_srgb(texel[0] / 255.0f);
      }
  ASSERT_GT(opaque, 500);
  EXPECT_LT(width[40], width[7] / 2 + 1); // narrower towards greater depth
  int changes = 0;
  for (int y = 1; y < n; ++y) changes += (width[y] > 0) != (width[y - 1] > 0);
  EXPECT_EQ(changes, 2); // one piece along its length
  if (std::string(GetParam()) == "kiwi-seed") {
    EXPECT_LT(dark / opaque, 0.05);
  }
  EXPECT_EQ(procedural_exemplar(GetParam(), {.resolution = 48}).texel, e.texel);
  EXPECT_NE(procedural_exemplar(GetParam(), {.resolution = 48, .seed = 2}).texel, e.texel);
}

INSTANTIATE_TEST_SUITE_P(All, Seeds, ::testing::Values("kiwi-seed", "watermelon-seed"));

TEST(KiwiFlesh, HasNoSeeds) {
  const Exemplar with = procedural_exemplar("kiwi", {.resolution = 64});
  const Exemplar flesh = procedural_exemplar("kiwi-flesh", {.resolution = 64});
  ASSERT_EQ(with.size, flesh.size);
  const auto dark_texels = [](const Exemplar& e) {
    int dark = 0;
    for (int z = 0; z < 64; ++z)
      for (int y = 20; y < 64; ++y) // the skin is brown
        for (int x = 0; x < 64; ++x) dark += e.at(x, y, z)[1] < 60;
    return dark;
  };
  EXPECT_GT(dark_texels(with), 1000);
  EXPECT_EQ(dark_texels(flesh), 0);
}

} // namespace
} // namespace pith
