#include "volume/field/depth_flood.h"

#include "tests/support/tet_grid.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"

#include <gtest/gtest.h>

using namespace pith;

namespace {

/// A bar that rises along x from held 0.1 to held 0.9 at its ends, with what `more` adds.
struct Bar {
  TetMesh mesh = tet_grid(24, 8, 8);
  DepthGraph graph = depth_graph(mesh, 0);
  PerVertex<float> depth = PerVertex<float>(mesh.vertex_count());
  PerVertex<std::uint8_t> held = PerVertex<std::uint8_t>(mesh.vertex_count());

  template <class More>
  explicit Bar(const More& more) {
    for (const VertexId v : all_ids<VertexId>(mesh.vertex_count())) {
      const Vec3d& x = mesh.position[v];
      depth[v] = static_cast<float>(0.1 + 0.8 * x.x() / 24 + more(x));
      held[v] = x.x() == 0 || x.x() == 24;
    }
  }
  std::vector<DepthExtremum> extrema(const PerVertex<float>& of, double persistence = 0.01) const {
    return extrema_of(mesh, 0, of, held, persistence);
  }
};

double bump(const Vec3d& x, const Vec3d& at, double height, double radius) {
  return height * std::max(0.0, 1 - (x - at).norm() / radius);
}

/// Smooth noise: waves of random directions.
double waves(const Vec3d& x, std::uint64_t seed) {
  double sum = 0;
  for (int k = 0; k < 6; ++k) {
    Random random(seed, static_cast<std::uint64_t>(k));
    const Vec3d along(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    sum += std::sin(along.dot(x) + random.uniform(0, 6.28));
  }
  return sum / 12;
}

} // namespace

// A bump and a pit are levelled, each to its own pass; a bump that does not persist and all the rest keep their bits.
TEST(DepthFlood, LevelsOnlyWhatPersists) {
  const Vec3d high(8, 4, 4), low(16, 4, 4), small(12, 0, 0);
  const Bar bar(
      [&](const Vec3d& x) { return bump(x, high, 0.4, 2.5) - bump(x, low, 0.4, 2.5) + bump(x, small, 0.04, 1.1); });
  const auto before = bar.extrema(bar.depth);
  ASSERT_EQ(before.size(), 2u);
  ASSERT_EQ(bar.extrema(bar.depth, 1e-4).size(), 3u); // `small` persists by less than 0.01
  const PerVertex<float> levelled = without_extrema(bar.graph, bar.depth, bar.held, 0.01).depth;
  const auto after = bar.extrema(levelled, 1e-6); // none where the levelled places meet the rest, either
  ASSERT_EQ(after.size(), 1u);
  EXPECT_EQ(after[0].place, small);
  std::size_t moved = 0;
  for (const VertexId v : bar.graph.vertex) {
    if (levelled[v] == bar.depth[v]) continue;
    ++moved;
    const Vec3d& x = bar.mesh.position[v];
    const bool at_high = (x - high).norm() < 3.6;
    EXPECT_TRUE(at_high || (x - low).norm() < 3.6) << x.transpose();
    const DepthExtremum& extremum = before[before[0].maximum == at_high ? 0 : 1];
    const double pass = bar.depth[extremum.saddle];
    EXPECT_GE((levelled[v] - pass) * (at_high ? -1 : 1), 0); // on the pass's other side
    EXPECT_NEAR(levelled[v], pass, 0.01);
    EXPECT_EQ(levelled[v] < bar.depth[v], at_high);
    // No plateau: something near by is nearer to the pass.
    const auto neighbors = bar.graph.neighbors[v];
    EXPECT_TRUE(std::any_of(neighbors.begin(), neighbors.end(), [&](VertexId n) {
      return at_high ? levelled[n] > levelled[v] : levelled[n] < levelled[v];
    }));
  }
  EXPECT_GT(moved, 20u);
  EXPECT_LT(moved, 400u); // of 2025
}

// Behind the pit lies a shelf that rises less than levelled places do: it must rise with them, or a dip would be
// left.
TEST(DepthFlood, OvertakesWhatDrainsIntoABasin) {
  Bar bar([](const Vec3d&) { return 0; });
  for (const VertexId v : bar.graph.vertex) {
    const double x = bar.mesh.position[v].x();
    bar.depth[v] = static_cast<float>(x <= 6    ? 0.2 + 0.05 * x
                                      : x <= 13 ? 0.3
                                      : x <= 21 ? 0.5 + 0.0002 * (x - 13)
                                                : 0.6 + 0.1 * (x - 22));
  }
  ASSERT_EQ(bar.extrema(bar.depth).size(), 2u); // the ridge at 6 and the pit behind it
  const PerVertex<float> levelled = without_extrema(bar.graph, bar.depth, bar.held, 0.01).depth;
  EXPECT_TRUE(bar.extrema(levelled, 1e-6).empty());
  for (const VertexId v : bar.graph.vertex) {
    const double x = bar.mesh.position[v].x();
    EXPECT_EQ(levelled[v] == bar.depth[v], x <= 6 || x >= 22) << x;
  }
}

TEST(DepthFlood, LeavesAMonotoneFieldAlone) {
  const Bar bar([](const Vec3d& x) { return 0.003 * std::sin(5 * x.y()); });
  EXPECT_EQ(without_extrema(bar.graph, bar.depth, bar.held, 0.01).depth, bar.depth);
}

// A basin that a constraint holds is none.
TEST(DepthFlood, LeavesHeldExtremaAlone) {
  const Vec3d at(8, 4, 4);
  Bar bar([&](const Vec3d& x) { return bump(x, at, 0.4, 2.5); });
  for (const VertexId v : bar.graph.vertex) bar.held[v] |= bar.mesh.position[v] == at;
  EXPECT_EQ(without_extrema(bar.graph, bar.depth, bar.held, 0.01).depth, bar.depth);
}

// Fields full of extrema, few places held: nothing is left, nothing held moves, once is enough, threads do not
// matter.
TEST(DepthFlood, EndsWithoutExtremaOnAnyField) {
  const TetMesh mesh = tet_ball(16, 10);
  const DepthGraph graph = depth_graph(mesh, 0);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    PerVertex<float> depth(mesh.vertex_count());
    PerVertex<std::uint8_t> held(mesh.vertex_count());
    Random random(seed, 100);
    const std::uint32_t one_in = 1 + random.below(static_cast<std::uint32_t>(mesh.vertex_count() / 2));
    for (const VertexId v : graph.vertex) {
      depth[v] = static_cast<float>(std::clamp(0.5 + waves(mesh.position[v], seed), 0.0, 1.0));
      held[v] = random.below(one_in) == 0;
    }
    held[graph.vertex[random.below(static_cast<std::uint32_t>(graph.vertex.size()))]] = 1;
    const double persistence = seed % 3 == 0 ? 0.0 : seed % 3 == 1 ? 0.01 : 0.2;
    const PerVertex<float> levelled = without_extrema(graph, depth, held, persistence).depth;
    const auto left = extrema_of(mesh, 0, levelled, held, persistence);
    EXPECT_TRUE(left.empty()) << "seed " << seed << ": " << left.size() << ", the worst " << left[0].persistence;
    for (const VertexId v : graph.vertex) {
      EXPECT_TRUE(!held[v] || levelled[v] == depth[v]);
      EXPECT_TRUE(levelled[v] >= -persistence && levelled[v] <= 1 + persistence);
    }
    EXPECT_EQ(without_extrema(graph, levelled, held, persistence).depth, levelled) << "seed " << seed;
    const ThreadLimit limit(1);
    EXPECT_EQ(without_extrema(graph, depth, held, persistence).depth, levelled) << "seed " << seed;
  }
}

// A part of the region without any constraint has nothing to be levelled to.
TEST(DepthFlood, LetsUnheldPartsBe) {
  TetMesh mesh = tet_grid(9, 3, 3);
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) // regions 0, 1, 0 along x
    mesh.region[t] = barycenter(mesh, t).x() > 3 && barycenter(mesh, t).x() < 6;
  const DepthGraph graph = depth_graph(mesh, 0);
  PerVertex<float> depth(mesh.vertex_count());
  PerVertex<std::uint8_t> held(mesh.vertex_count());
  for (const VertexId v : graph.vertex) {
    const Vec3d& x = mesh.position[v];
    depth[v] = static_cast<float>(0.5 + 0.4 * std::sin(2 * x.x()) * std::cos(x.y()));
    held[v] = x.x() == 0;
  }
  const PerVertex<float> levelled = without_extrema(graph, depth, held, 0.01).depth;
  std::size_t moved = 0;
  for (const VertexId v : graph.vertex) {
    EXPECT_TRUE(mesh.position[v].x() < 6 || levelled[v] == depth[v]);
    moved += levelled[v] != depth[v];
  }
  EXPECT_GT(moved, 0u);
  for (const DepthExtremum& one : extrema_of(mesh, 0, levelled, held)) EXPECT_GE(one.place.x(), 6);
}
