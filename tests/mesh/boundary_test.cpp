#include "tests/support/tri_shapes.h"
#include "volume/mesh/boundary.h"

#include <gtest/gtest.h>

namespace pith {
namespace {

/// A unit cube of six tets around its diagonal (Kuhn); tets 0–2 may get a region of their own.
TetMesh kuhn_cube() {
  TetMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.position.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2 & 1)});
  const int paths[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
  for (const auto& p : paths) mesh.corner.push_back({VertexId(0u), VertexId(p[0]), VertexId(p[1]), VertexId(7u)});
  mesh.region.assign(6, 0);
  connect(mesh);
  return mesh;
}

TEST(Boundary, SkinOfACubeIsClosedAndOutward) {
  const TetMesh mesh = kuhn_cube();
  ASSERT_NO_THROW(validate(mesh));
  const Boundary boundary = boundary_of(mesh);
  EXPECT_EQ(boundary.facet_count(), 12u);
  const BoundarySurface skin = surface_of(mesh, boundary);
  EXPECT_TRUE(surface_defects(skin.surface).clean());
  EXPECT_DOUBLE_EQ(signed_volume(skin.surface), 1);
  for (const VertexId v : all_ids<VertexId>(skin.vertex.size()))
    EXPECT_EQ(skin.surface.position[v], mesh.position[skin.vertex[v]]);
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) {
    EXPECT_FALSE(boundary.behind[f].exists());
    EXPECT_EQ(boundary.facet_of_tet[boundary.tet[f]][boundary.opposite[f]], f);
    if (f > 0) {
      const FacetId before(f - 1); // ascending (tet, opposite)
      EXPECT_LT(4 * boundary.tet[before] + boundary.opposite[before], 4 * boundary.tet[f] + boundary.opposite[f]);
    }
  }
}

TEST(Boundary, AnInterfaceAppearsOnceForEachSide) {
  TetMesh mesh = kuhn_cube();
  for (unsigned t = 0; t < 3; ++t) mesh.region[TetId(t)] = 1;
  const Boundary boundary = boundary_of(mesh);
  EXPECT_EQ(boundary.facet_count(), 12u + 4u);
  std::size_t behind = 0;
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count()))
    if (const TetId other = boundary.behind[f]; other.exists()) {
      ++behind;
      EXPECT_NE(mesh.region[other], mesh.region[boundary.tet[f]]);
    }
  EXPECT_EQ(behind, 4u);
}

TEST(Boundary, NormalsPointOutAndVanishInside) {
  TetMesh mesh = kuhn_cube();
  mesh.position.push_back({5, 5, 5}); // a vertex of no tet
  const PerVertex<Vec3d> normal = skin_normals(mesh, boundary_of(mesh));
  for (unsigned v = 0; v < 8; ++v) {
    EXPECT_NEAR(normal[VertexId(v)].norm(), 1, 1e-12);
    EXPECT_GT(normal[VertexId(v)].dot(mesh.position[VertexId(v)] - Vec3d::Constant(0.5)), 0.5);
  }
  EXPECT_EQ(normal[VertexId(8u)], Vec3d(0, 0, 0));
}

} // namespace
} // namespace pith
