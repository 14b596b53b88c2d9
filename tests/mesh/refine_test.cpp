// Refinement before anything else: no skin-to-skin tets, vertices on strokes, the boundary untouched.
#include "volume/mesh/refine.h"

#include "tests/support/tet_grid.h"

#include <gtest/gtest.h>

namespace pith {
namespace {

double volume_of(const TetMesh& mesh) {
  double sum = 0;
  for (TetId t : all_ids<TetId>(mesh.tet_count())) sum += signed_volume(mesh, t);
  return sum;
}

std::size_t skin_tets(const TetMesh& mesh) {
  std::vector<bool> skin(mesh.vertex_count(), false);
  for (const auto& corner : boundary_of(mesh).corner)
    for (VertexId v : corner) skin[v] = true;
  std::size_t count = 0;
  for (const auto& c : mesh.corner) count += skin[c[0]] && skin[c[1]] && skin[c[2]] && skin[c[3]];
  return count;
}

TEST(Refine, SplitsTetsThatHaveAllCornersOnTheSkin) {
  for (int cubes : {1, 2, 4}) {
    const TetMesh mesh = tet_grid(cubes, cubes, 3, 1.0);
    const Boundary boundary = boundary_of(mesh);
    Indexed<FacetId, TriangleId> input;
    for (FacetId f : all_ids<FacetId>(boundary.facet_count())) input.push_back(TriangleId(1000 + f));
    ASSERT_GT(skin_tets(mesh), 0u);
    const RefineResult refined = refine(mesh, input);
    EXPECT_EQ(refined.skin_tets, skin_tets(mesh));
    EXPECT_EQ(skin_tets(refined.mesh), 0u);
    EXPECT_NO_THROW(validate(refined.mesh));
    EXPECT_NEAR(volume_of(refined.mesh), volume_of(mesh), 1e-12);
    // The boundary is the same facets, each with its own input triangle.
    const Boundary after = boundary_of(refined.mesh);
    ASSERT_EQ(after.facet_count(), boundary.facet_count());
    ASSERT_EQ(refined.input.size(), after.facet_count());
    for (FacetId f : all_ids<FacetId>(after.facet_count())) {
      const FacetId old(refined.input[f].value - 1000);
      Box a, b;
      for (int i = 0; i < 3; ++i)
        a.add(refined.mesh.position[after.corner[f][i]]), b.add(mesh.position[boundary.corner[old][i]]);
      EXPECT_EQ(a.low, b.low);
      EXPECT_EQ(a.high, b.high);
    }
  }
}

TEST(Refine, LeavesAMeshWithoutSuchTetsAlone) {
  const TetMesh mesh = tet_ball(6, 10.0);
  ASSERT_EQ(skin_tets(mesh), 0u);
  const RefineResult refined = refine(mesh, {});
  EXPECT_EQ(refined.split, 0u);
  EXPECT_EQ(refined.mesh.corner, mesh.corner);
  EXPECT_EQ(refined.mesh.position, mesh.position);
}

TEST(Refine, MovesInnerVerticesOntoStrokes) {
  const TetMesh mesh = tet_grid(6, 6, 6, 1.0);
  RefineOptions options;
  options.stroke = {{{3.2, 3.15, 1.1}, {3.1, 3.2, 4.9}}};
  const RefineResult refined = refine(mesh, {}, options);
  EXPECT_GE(refined.moved, 3u);
  EXPECT_NO_THROW(validate(refined.mesh));
  EXPECT_NEAR(volume_of(refined.mesh), volume_of(mesh), 1e-9);
  std::size_t on_stroke = 0;
  const Vec3d a = options.stroke[0][0], b = options.stroke[0][1];
  for (const Vec3d& x : refined.mesh.position) {
    const double t = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    on_stroke += (x - (a + t * (b - a))).norm() < 1e-12;
  }
  EXPECT_EQ(on_stroke, refined.moved);
}

} // namespace
} // namespace pith
