// The meshes that other tests stand on.
#include "tests/support/tet_grid.h"

#include "volume/mesh/boundary.h"

#include <gtest/gtest.h>

using namespace pith;

TEST(TetGrid, ABoxIsValidAndFull) {
  const TetMesh box = tet_grid(3, 4, 5, 0.5);
  validate(box);
  EXPECT_EQ(box.tet_count(), 6u * 60);
  double volume = 0;
  for (const TetId t : all_ids<TetId>(box.tet_count())) volume += signed_volume(box, t);
  EXPECT_NEAR(volume, 60 * 0.125, 1e-12);
  EXPECT_EQ(boundary_of(box).facet_count(), 4u * (12 + 15 + 20));
}

TEST(TetGrid, ABallIsValidAndRound) {
  for (const int n : {2, 4, 10}) {
    const TetMesh ball = tet_ball(n, 3);
    validate(ball);
    const Boundary boundary = boundary_of(ball);
    EXPECT_EQ(boundary.facet_count(), 12u * n * n);
    for (const auto& corner : boundary.corner)
      for (const VertexId v : corner) EXPECT_NEAR(ball.position[v].norm(), 3, 1e-12);
    std::vector<bool> skin(ball.vertex_count());
    for (const auto& corner : boundary.corner)
      for (const VertexId v : corner) skin[v] = true;
    for (const auto& corner : ball.corner)
      EXPECT_FALSE(skin[corner[0]] && skin[corner[1]] && skin[corner[2]] && skin[corner[3]]);
  }
}
