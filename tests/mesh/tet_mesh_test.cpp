#include "volume/base/error.h"
#include "volume/mesh/tet_mesh.h"

#include <gtest/gtest.h>

namespace pith {
namespace {

/// Two tets that share the facet (1, 2, 3).
TetMesh two_tets() {
  TetMesh mesh;
  mesh.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.corner = {{VertexId(0u), VertexId(1u), VertexId(2u), VertexId(3u)},
                 {VertexId(4u), VertexId(1u), VertexId(3u), VertexId(2u)}};
  mesh.region = {0, 0};
  connect(mesh);
  return mesh;
}

TEST(TetMesh, FacetsFaceOutwards) {
  const TetMesh mesh = two_tets();
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    for (int i = 0; i < 4; ++i) {
      TetMesh one; // the tet of the facet and a point beyond it, seen from the facet
      for (const int c : facet_corners[i]) one.position.push_back(mesh.position[mesh.corner[t][c]]);
      one.position.push_back(mesh.position[mesh.corner[t][i]]);
      one.corner = {{VertexId(0u), VertexId(1u), VertexId(2u), VertexId(3u)}};
      EXPECT_LT(signed_volume(one, TetId(0u)), 0); // the opposite corner lies behind it
    }
}

TEST(TetMesh, ConnectsAcrossTheSharedFacetOnly) {
  const TetMesh mesh = two_tets();
  EXPECT_NO_THROW(validate(mesh));
  EXPECT_EQ(mesh.neighbor[TetId(0u)][0], TetId(1u));
  EXPECT_EQ(mesh.neighbor[TetId(1u)][0], TetId(0u));
  for (int i = 1; i < 4; ++i) {
    EXPECT_FALSE(mesh.neighbor[TetId(0u)][i].exists());
    EXPECT_FALSE(mesh.neighbor[TetId(1u)][i].exists());
  }
  EXPECT_DOUBLE_EQ(signed_volume(mesh, TetId(0u)), 1.0 / 6);
  EXPECT_DOUBLE_EQ(signed_volume(mesh, TetId(1u)), 1.0 / 3);
  EXPECT_EQ(barycenter(mesh, TetId(0u)), Vec3d(0.25, 0.25, 0.25));
}

TEST(TetMesh, RefusesThreeTetsAtOneFacet) {
  TetMesh mesh = two_tets();
  mesh.position.push_back({2, 2, 2});
  mesh.corner.push_back({VertexId(5u), VertexId(1u), VertexId(3u), VertexId(2u)});
  EXPECT_THROW(connect(mesh), InvalidInput);
}

TEST(TetMesh, ValidateNamesTheOffender) {
  const auto complaint = [](const TetMesh& mesh) -> std::string {
    try {
      validate(mesh);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  TetMesh mesh = two_tets();
  EXPECT_EQ(complaint(mesh), "");
  std::swap(mesh.corner[TetId(1u)][1], mesh.corner[TetId(1u)][2]);
  EXPECT_NE(complaint(mesh).find("tet 1 has volume"), std::string::npos);
  mesh = two_tets();
  mesh.neighbor[TetId(1u)][0] = TetId();
  EXPECT_NE(complaint(mesh).find("not neighbours of each other"), std::string::npos);
  mesh = two_tets();
  mesh.position[VertexId(4u)].y() = std::nan("");
  EXPECT_NE(complaint(mesh).find("vertex 4"), std::string::npos);
  mesh = two_tets();
  mesh.corner[TetId(0u)][2] = VertexId(17u);
  EXPECT_NE(complaint(mesh).find("vertex 17 of 5"), std::string::npos);
  mesh = two_tets();
  mesh.region.pop_back();
  EXPECT_NE(complaint(mesh).find("region"), std::string::npos);
}

TEST(TetMesh, RowsAroundVertices) {
  const TetMesh mesh = two_tets();
  const VertexTets tets = tets_around_vertices(mesh);
  EXPECT_EQ(tets[VertexId(0u)].size(), 1u);
  ASSERT_EQ(tets[VertexId(2u)].size(), 2u);
  EXPECT_EQ(tets[VertexId(2u)][0], TetId(0u));
  EXPECT_EQ(tets[VertexId(2u)][1], TetId(1u));
  const VertexNeighbors neighbors = vertices_around_vertices(mesh);
  const auto around_0 = neighbors[VertexId(0u)], around_1 = neighbors[VertexId(1u)];
  EXPECT_EQ(std::vector<VertexId>(around_0.begin(), around_0.end()),
            (std::vector<VertexId>{VertexId(1u), VertexId(2u), VertexId(3u)}));
  EXPECT_EQ(std::vector<VertexId>(around_1.begin(), around_1.end()),
            (std::vector<VertexId>{VertexId(0u), VertexId(2u), VertexId(3u), VertexId(4u)}));
}

} // namespace
} // namespace pith
