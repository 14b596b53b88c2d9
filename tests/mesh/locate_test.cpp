// Point location: exact, the lowest closed owner, and independent of hints.
#include "volume/mesh/locate.h"

#include "tests/support/tet_grid.h"
#include "volume/base/random.h"
#include "volume/mesh/orientation.h"

#include <gtest/gtest.h>

namespace pith {
namespace {

bool closed_contains(const TetMesh& mesh, TetId t, const Vec3d& x) {
  for (const auto& f : facet_corners)
    if (orientation(mesh.position[mesh.corner[t][f[0]]], mesh.position[mesh.corner[t][f[1]]],
                    mesh.position[mesh.corner[t][f[2]]], x) > 0)
      return false;
  return true;
}

TetId lowest_by_search(const TetMesh& mesh, const Vec3d& x, std::int32_t region) {
  for (TetId t : all_ids<TetId>(mesh.tet_count()))
    if ((region < 0 || mesh.region[t] == region) && closed_contains(mesh, t, x)) return t;
  return {};
}

TEST(Orientation, IsExactWhereDoublesRoundToZero) {
  const Vec3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_EQ(orientation(a, b, c, {0.3, 0.3, 1}), 1);
  EXPECT_EQ(orientation(a, b, c, {0.3, 0.3, -1}), -1);
  EXPECT_EQ(orientation(a, b, c, {5, 7, 0}), 0);
  // Nearly coplanar far from the origin: the exact answer is the sign of the last bit.
  const Vec3d o(1e6, 1e6, 1e6);
  const Vec3d above(o.x() + 0.25, o.y() + 0.25, std::nextafter(1e6, 2e6));
  EXPECT_EQ(orientation(o, o + Vec3d(1, 0, 0), o + Vec3d(0, 1, 0), above), 1);
  EXPECT_EQ(orientation(o, o + Vec3d(0, 1, 0), o + Vec3d(1, 0, 0), above), -1);
}

TEST(Locator, AgreesWithExhaustiveSearchAtRandomAndDegeneratePoints) {
  TetMesh mesh = tet_grid(4, 3, 5, 1.0);
  for (TetId t : all_ids<TetId>(mesh.tet_count()))
    mesh.region[t] = barycenter(mesh, t).z() > 0.5 * bounds_of(mesh).high.z();
  const Boundary boundary = boundary_of(mesh);
  const Locator locator(mesh, boundary);
  const Box box = bounds_of(mesh);
  Random random(7);
  int degenerate = 0;
  for (int i = 0; i < 4000; ++i) {
    Vec3d x;
    for (int k = 0; k < 3; ++k) {
      x[k] = random.uniform(box.low[k], box.high[k]);
      if (i % 3 != 0 && random.uniform() < 0.6) // on grid planes, edges, vertices
        x[k] = mesh.position[VertexId(random.below(static_cast<std::uint32_t>(mesh.vertex_count())))][k],
        ++degenerate;
    }
    if (i % 5 == 0) { // the middle of an edge, as a cut makes it
      const auto& c = mesh.corner[TetId(random.below(static_cast<std::uint32_t>(mesh.tet_count())))];
      x = mesh.position[c[0]] + random.uniform() * (mesh.position[c[1]] - mesh.position[c[0]]);
    }
    for (std::int32_t region : {-1, 0, 1}) {
      const TetId expected = lowest_by_search(mesh, x, region);
      const TetId hint(random.below(static_cast<std::uint32_t>(mesh.tet_count())));
      const Location with = locator.locate(x, region, hint), without = locator.locate(x, region);
      EXPECT_EQ(with.inside, expected.exists());
      EXPECT_EQ(with.tet, without.tet);
      EXPECT_EQ(with.barycentric, without.barycentric);
      if (expected.exists()) {
        EXPECT_EQ(with.tet, expected);
      }
    }
  }
  EXPECT_GT(degenerate, 1000);
}

TEST(Locator, TakesTheNearestTetForPointsOutside) {
  const TetMesh mesh = tet_grid(3, 3, 3, 1.0);
  const Boundary boundary = boundary_of(mesh);
  const Locator locator(mesh, boundary);
  const Box box = bounds_of(mesh);
  const Location at = locator.locate({box.high.x() + 0.5, 0.4 * box.high.y(), 0.3 * box.high.z()});
  ASSERT_TRUE(at.tet.exists());
  EXPECT_FALSE(at.inside);
  Vec3d point = Vec3d::Zero();
  for (int i = 0; i < 4; ++i) point += at.barycentric[i] * mesh.position[mesh.corner[at.tet][i]];
  EXPECT_NEAR(point.x(), box.high.x(), 1e-12);
  EXPECT_NEAR(point.y(), 0.4 * box.high.y(), 1e-12);
}

TEST(FacetTree, FindsTheNearestTriangleLikeASearch) {
  std::vector<std::array<Vec3d, 3>> triangles;
  Random random(3);
  const auto point = [&] { return Vec3d(random.uniform(), random.uniform(), random.uniform()); };
  for (int i = 0; i < 300; ++i) {
    const Vec3d a = point();
    triangles.push_back({a, a + 0.1 * point(), a + 0.1 * point()});
  }
  triangles.push_back(triangles[17]); // an equal one: the lower number wins
  const FacetTree tree(triangles);
  for (int i = 0; i < 500; ++i) {
    const Vec3d x = 2 * point() - Vec3d::Constant(0.5);
    double least = 1e300;
    std::uint32_t best = 0;
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      if (const double d = closest_point(triangles[t], x).squared_distance; d < least) least = d, best = t;
    const NearestFacet nearest = tree.nearest(x);
    EXPECT_EQ(nearest.facet, best);
    EXPECT_EQ(nearest.squared_distance, least);
  }
}

} // namespace
} // namespace pith
