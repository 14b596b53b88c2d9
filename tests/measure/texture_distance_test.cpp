// Distances between sets of pictures: 0 for one set and itself, closed forms, and growth with what spoils a picture.
#include "tests/measure/pictures.h"
#include "volume/base/error.h"
#include "volume/measure/patch_search.h"
#include "volume/measure/texture_distance.h"

#include <gtest/gtest.h>

namespace pith {
namespace {

using namespace testing;

TEST(Wasserstein, ClosedForms) {
  EXPECT_DOUBLE_EQ(wasserstein_distance({1, 2, 3}, {3, 1, 2}), 0);
  EXPECT_NEAR(wasserstein_distance({1, 2, 3}, {1.5, 2.5, 3.5}), 0.5, 1e-12);
  EXPECT_NEAR(wasserstein_distance({0, 0}, {0, 1, 1}), 2.0 / 3, 1e-12); // sizes differ
  EXPECT_NEAR(wasserstein_distance({0, 1}, {0, 0, 1, 1}), 0, 1e-12);
  EXPECT_EQ(wasserstein_distance({}, {1}), 0);
}

TEST(PatchSearch, FindsWhatTryingAllFinds) {
  const std::vector<Slice> a = textured_set(1, 3), b = textured_set(2, 3);
  for (const int side : {3, 7}) {
    std::vector<Slice> banded = b;
    for (Slice& s : banded)
      for (std::size_t i = 0; i < s.depth.size(); ++i) s.depth[i] = float(i % 48) / 48;
    std::vector<Slice> banded_a = a;
    for (Slice& s : banded_a)
      for (std::size_t i = 0; i < s.depth.size(); ++i) s.depth[i] = float(i % 48) / 48;
    const PatchTable query = patches_of(banded_a, side, 4, 200), table = patches_of(banded, side, 4, 1500);
    ASSERT_EQ(query.count(), 200u);
    ASSERT_EQ(table.count(), 1500u);
    const std::vector<float> found = nearest_distances(query, table);
    for (std::size_t i = 0; i < query.count(); ++i) {
      double best = INFINITY;
      for (std::size_t j = 0; j < table.count(); ++j) {
        if (table.band[j] != query.band[i]) continue;
        double sum = 0;
        for (int k = 0; k < query.dimension; ++k) sum += std::pow(query.row(i)[k] - table.row(j)[k], 2);
        best = std::min(best, sum);
      }
      EXPECT_NEAR(found[i], std::sqrt(best / query.dimension), 1e-5);
    }
  }
}

TEST(PatchSearch, HasNothingToSayOfABandThatIsEmpty) {
  std::vector<Slice> low{textured(1)}, high{textured(1)};
  std::fill(high[0].depth.begin(), high[0].depth.end(), 0.9f);
  for (const float d : nearest_distances(patches_of(low, 7, 2, 50), patches_of(high, 7, 2, 50))) EXPECT_EQ(d, -1);
}

TEST(PatchSearch, TakesOnlyPatchesThatLieInside) {
  Slice s = textured(1, 20);
  s.inside[s.index(10, 10)] = 0;
  EXPECT_EQ(patches_of(std::vector<Slice>{s}, 7, 1, 100000).count(), std::size_t(14 * 14 - 49));
  const Slice half = half_size(s);
  EXPECT_EQ(half.width(), 10);
  EXPECT_EQ(std::count(half.inside.begin(), half.inside.end(), 0), 1);
}

TEST(TextureDistance, OfASetAndItselfIsNothing) {
  const std::vector<Slice> set = textured_set(3, 4);
  const TextureDistance d = texture_distance(set, set);
  EXPECT_GT(d.patches, 1000u);
  EXPECT_NEAR(d.coherence, 0, 1e-6);
  EXPECT_NEAR(d.completeness, 0, 1e-6);
  EXPECT_EQ(d.wasserstein, 0);
  EXPECT_EQ(d.color, 0);
  EXPECT_EQ(d.autocorrelation, 0);
}

TEST(TextureDistance, OfFlatColoursIsTheirDifference) {
  std::vector<Slice> dark{slice_of(32, 32)}, light{slice_of(32, 32)};
  for (float& v : dark[0].color.pixel) v = linear_from_srgb(0.3f);
  for (float& v : light[0].color.pixel) v = linear_from_srgb(0.7f);
  const TextureDistance d = texture_distance(dark, light);
  EXPECT_NEAR(d.coherence, 0.4, 1e-4);
  EXPECT_NEAR(d.completeness, 0.4, 1e-4);
  EXPECT_NEAR(d.color, 0.4, 1e-4);
  EXPECT_EQ(d.autocorrelation, 0); // neither varies
}

/// Each spoiling grows in three steps, from nothing: every distance named must grow with it.
TEST(TextureDistance, GrowsWithBlurFadingAndShuffling) {
  const std::vector<Slice> exemplar = textured_set(5, 6);
  const TextureDistanceOptions options{.patches = 2048};
  const auto step = [&](const auto& change) {
    return texture_distance(changed(exemplar, change), exemplar, options);
  };
  TextureDistance last;
  for (const int radius : {1, 2, 4}) {
    const TextureDistance d = step([&](const Slice& s, std::size_t) { return blurred(s, radius); });
    EXPECT_GT(d.completeness, 1.1 * last.completeness) << radius; // what is sharp in the exemplar is not shown
    EXPECT_GT(d.wasserstein, 1.1 * last.wasserstein) << radius;
    EXPECT_GT(d.autocorrelation, 1.1 * last.autocorrelation) << radius;
    EXPECT_GT(d.color, 1.1 * last.color) << radius;
    last = d;
  }
  last = {};
  for (const float loss : {0.2f, 0.4f, 0.7f}) {
    const TextureDistance d = step([&](const Slice& s, std::size_t) { return faded(s, loss); });
    EXPECT_GT(d.coherence, 1.1 * last.coherence) << loss;
    EXPECT_GT(d.completeness, 1.1 * last.completeness) << loss;
    EXPECT_GT(d.wasserstein, 1.1 * last.wasserstein) << loss;
    EXPECT_GT(d.color, 1.1 * last.color) << loss;
    last = d;
  }
  last = {};
  for (const double part : {0.1, 0.4, 1.5}) {
    const TextureDistance d = step([&](const Slice& s, std::size_t i) { return shuffled(s, part, i); });
    EXPECT_GT(d.coherence, 1.1 * last.coherence) << part; // what is shown is nowhere in the exemplar
    EXPECT_GT(d.completeness, 1.1 * last.completeness) << part;
    EXPECT_GT(d.wasserstein, 1.1 * last.wasserstein) << part;
    EXPECT_GT(d.autocorrelation, 1.1 * last.autocorrelation) << part;
    EXPECT_EQ(d.color, 0) << part; // the same colours
    last = d;
  }
}

/// Against another sample of the same texture, distributions tell blur and fading; nearest patches tell only what is
/// foreign to the texture (a smooth patch is near to many).
TEST(TextureDistance, AgainstAnotherSampleGrowsAsWell) {
  const std::vector<Slice> exemplar = textured_set(5, 24), shown = textured_set(6, 24);
  const TextureDistanceOptions options{.patches = 2048};
  const auto step = [&](const auto& change) { return texture_distance(changed(shown, change), exemplar, options); };
  const TextureDistance clean = step([](const Slice& s, std::size_t) { return s; });
  const TextureDistance soft = step([](const Slice& s, std::size_t) { return blurred(s, 3); });
  const TextureDistance pale = step([](const Slice& s, std::size_t) { return faded(s, 0.5f); });
  const TextureDistance mixed = step([](const Slice& s, std::size_t i) { return shuffled(s, 1, i); });
  EXPECT_GT(soft.wasserstein, 1.3 * clean.wasserstein);
  EXPECT_GT(soft.color, 2 * clean.color);
  EXPECT_GT(pale.wasserstein, 1.3 * clean.wasserstein);
  EXPECT_GT(pale.color, 2 * clean.color);
  EXPECT_GT(mixed.wasserstein, 1.3 * clean.wasserstein); // nearest patches say nothing here: see the header
  EXPECT_GT(mixed.autocorrelation, 3 * clean.autocorrelation);
}

TEST(TextureDistance, TellsLayersOfDepthApart) {
  // The same two colours, the other way round in depth: alike as a whole, unlike band by band.
  std::vector<Slice> a{slice_of(32, 32)}, b{slice_of(32, 32)};
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const bool deep = x >= 16;
      a[0].depth[a[0].index(x, y)] = b[0].depth[a[0].index(x, y)] = deep ? 0.75f : 0.25f;
      for (int c = 0; c < 3; ++c) a[0].color.at(x, y)[c] = deep, b[0].color.at(x, y)[c] = !deep;
    }
  EXPECT_NEAR(texture_distance(a, b, {.bands = 1}).color, 0, 1e-6);
  EXPECT_NEAR(texture_distance(a, b, {.bands = 2}).color, 1, 1e-6);
}

TEST(TextureDistance, IsTheSameForAnyNumberOfThreads) {
  const std::vector<Slice> a = textured_set(7, 4), b = textured_set(8, 4);
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return texture_distance(a, b);
  };
  const TextureDistance one = with(1), two = with(2);
  EXPECT_EQ(one.coherence, two.coherence);
  EXPECT_EQ(one.completeness, two.completeness);
  EXPECT_EQ(one.wasserstein, two.wasserstein);
  EXPECT_EQ(one.autocorrelation, two.autocorrelation);
  EXPECT_THROW(texture_distance(a, b, {.patch = 0}), InvalidInput);
}

} // namespace
} // namespace pith
