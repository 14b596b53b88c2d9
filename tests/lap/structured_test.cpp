// Structured textures: cells between joints on a bent bar. Pieces that are brought into line and cut along seams that
// match against pieces as the paper pastes them; and the minimum cut by itself.
#include "tests/lap/types_fixture.h"
#include "volume/lap/min_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>

namespace pith {
namespace {

using testing::BentBar;
using testing::TypeCase;

/// Cells of 1/2 × 1/3 × 1/3 texture width, dark and each of its own colour, in running bond, between white joints.
Exemplar cells() {
  constexpr int n = 64, joint = 3;
  Exemplar e;
  e.name = "cells";
  e.size = {n, n, n, 1};
  e.wrap = {Wrap::repeat, Wrap::repeat, Wrap::repeat, Wrap::clamp};
  e.channel = {{.name = "color", .semantic = Semantic::color, .components = 3, .srgb = false, .low = 0, .high = 1}};
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const int row = y * 3 / n, layer = z * 3 / n, along = (x + (row + layer) % 2 * n / 4) % n;
        const bool in_joint = along % (n / 2) < joint || y - row * n / 3 < joint || z - layer * n / 3 < joint;
        for (int c = 0; c < 3; ++c)
          e.texel.push_back(in_joint ? 250 : 20 + static_cast<int>(hash_of(1, along * 2 / n, row, layer, c) % 80));
      }
  return e;
}

struct Filled {
  LapResult result;
  double mismatch = 0; ///< mean difference of the two look-ups seen most, where both are seen well
  double least = 1;    ///< coverage of 10⁵ points
};

Filled filled(const BentBar& bar, bool align, bool structured) {
  TypeCase one(bar, TextureType::tensor_2a, 8);
  one.exemplar = cells();
  one.options.align = align;
  one.options.structured = structured;
  Filled f{.result = one.filled()};
  const Layer& layer = f.result.layer;
  const LayerReader reader(layer, false);
  Random random(3);
  double sum = 0;
  int met = 0;
  for (int i = 0; i < 100000; ++i) {
    const std::uint32_t t = random.below(static_cast<std::uint32_t>(bar.mesh.tet_count()));
    SimplexPoint point;
    float total = 0;
    for (float& b : point.barycentric) total += b = static_cast<float>(-std::log(1 - random.uniform()));
    for (float& b : point.barycentric) b /= total;
    const std::span<const Lookup> row(layer.lookup.data() + layer.begin[t], layer.begin[t + 1] - layer.begin[t]);
    f.least = std::min<double>(f.least, coverage_of(reader, row, point).coverage);
    // The uppermost, and what it lets through.
    for (std::size_t k = row.size(); k-- > 0;) {
      const float alpha = sight_of(reader, row[k], point.barycentric).alpha;
      if (alpha <= 0.02f) continue;
      if (alpha < 0.3f || alpha > 0.7f) break;
      const LayerValue over = composite(reader, row.subspan(k, 1), point),
                       under = composite(reader, row.first(k), point);
      if (under.coverage < 0.9f) break;
      double squared = 0;
      for (int c = 0; c < 3; ++c) {
        const double d = over.value[c] / over.coverage - under.value[c] / under.coverage;
        squared += d * d;
      }
      sum += std::sqrt(squared);
      ++met;
      break;
    }
  }
  EXPECT_GT(met, 500);
  f.mismatch = sum / met;
  return f;
}

TEST(Structured, PiecesMatchWhereTheyMeetAndLeaveNoHole) {
  const BentBar bar(6);
  const Filled paper = filled(bar, false, false), aligned = filled(bar, true, false), cut = filled(bar, true, true);
  EXPECT_LT(aligned.mismatch, paper.mismatch);
  EXPECT_LT(cut.mismatch, 0.25 * paper.mismatch)
      << "as the paper " << paper.mismatch << ", aligned " << aligned.mismatch << ", cut " << cut.mismatch;
  EXPECT_GT(cut.least, 0.98);
  ASSERT_NO_THROW(validate(cut.result.layer, bar.mesh.tet_count()));
  EXPECT_LT(paper.result.layer.blend.correlation, 0.1) << "pieces begun at random have nothing in common";
  EXPECT_GT(cut.result.layer.blend.correlation, 0.6) << "pieces that match are alike";
  EXPECT_EQ(cut.result.layer.mask.size(), cut.result.layer.patch.size());
  std::vector<bool> used(cut.result.layer.patch.size());
  for (const Lookup& lookup : cut.result.layer.lookup) used[lookup.patch] = true;
  EXPECT_TRUE(std::all_of(used.begin(), used.end(), [](bool u) { return u; })) << "a patch that nothing shows";
}

TEST(Structured, IsTheSameAtOneAndTwoThreads) {
  const BentBar bar(4);
  TypeCase one(bar, TextureType::tensor_2a, 10);
  one.exemplar = cells();
  one.options.structured = true;
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return one.filled().layer;
  };
  const Layer a = run(1), b = run(2);
  ASSERT_EQ(a.corner.size(), b.corner.size());
  EXPECT_EQ(0, std::memcmp(a.corner.data(), b.corner.data(), a.corner.size() * sizeof(float)));
  ASSERT_EQ(a.lookup.size(), b.lookup.size());
  EXPECT_EQ(0, std::memcmp(a.lookup.data(), b.lookup.data(), a.lookup.size() * sizeof(Lookup)));
  ASSERT_EQ(a.mask.size(), b.mask.size());
  for (std::size_t i = 0; i < a.mask.size(); ++i)
    EXPECT_TRUE(std::equal(a.mask[i].alpha.begin(), a.mask[i].alpha.end(), b.mask[i].alpha.begin()));
}

TEST(MinCut, PartsAtTheCheapestEdges) {
  // Two chains from node 0 to node 5: over 1, 2 (costs 5, 1, 7) and over 3, 4 (2, 6, 4).
  const std::vector<CutEdge> edges{{0, 1, 5}, {1, 2, 1}, {2, 5, 7}, {0, 3, 2}, {3, 4, 6}, {4, 5, 4}};
  std::vector<std::int64_t> source(6, 0), sink(6, 0);
  source[0] = never;
  sink[5] = never;
  EXPECT_EQ(min_cut(source, sink, edges), (std::vector<std::uint8_t>{1, 1, 0, 0, 0, 0}));
}

TEST(MinCut, IsNoWorseThanAnyOtherCut) {
  // Small random graphs against all their cuts.
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    constexpr std::uint32_t n = 9;
    std::vector<std::int64_t> source(n), sink(n);
    std::vector<CutEdge> edges;
    for (std::uint32_t i = 0; i < n; ++i) {
      source[i] = random.below(3) ? 0 : random.below(20);
      sink[i] = random.below(3) ? 0 : random.below(20);
      for (std::uint32_t j = 0; j < i; ++j)
        if (random.below(2)) edges.push_back({i, j, random.below(10)});
    }
    const auto cost = [&](const auto& side) {
      std::int64_t sum = 0;
      for (std::uint32_t i = 0; i < n; ++i) sum += side(i) ? sink[i] : source[i];
      for (const CutEdge& e : edges) sum += side(e.a) != side(e.b) ? e.cost : 0;
      return sum;
    };
    const std::vector<std::uint8_t> found = min_cut(source, sink, edges);
    std::int64_t best = never;
    for (std::uint32_t set = 0; set < 1u << n; ++set)
      best = std::min(best, cost([&](std::uint32_t i) { return bool(set >> i & 1); }));
    EXPECT_EQ(cost([&](std::uint32_t i) { return bool(found[i]); }), best) << "graph " << seed;
  }
}

} // namespace
} // namespace pith
