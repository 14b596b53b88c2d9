#include "tests/support/tri_shapes.h"
#include "volume/mesh/tri_mesh.h"

#include <gtest/gtest.h>
#include <numbers>

namespace pith {
namespace {

using testing::box_surface;
using testing::inside_out;
using testing::sphere_surface;
using testing::together;

const TriMesh cube = box_surface({0, 0, 0}, {1, 2, 3});

TEST(TriMesh, VolumeOfABoxIsExactAndSigned) {
  EXPECT_DOUBLE_EQ(signed_volume(cube), 6);
  EXPECT_DOUBLE_EQ(signed_volume(inside_out(cube)), -6);
  // Far from the origin nothing is lost.
  EXPECT_DOUBLE_EQ(signed_volume(box_surface({1e9, 1e9, 1e9}, {1e9 + 1, 1e9 + 2, 1e9 + 3})), 6);
  EXPECT_NEAR(signed_volume(sphere_surface(5, 2)), 32 * std::numbers::pi / 3, 0.05);
}

TEST(TriMesh, WeldingMergesEqualPositionsAndKeepsOrder) {
  TriMesh soup;
  soup.position.push_back({9, 9, 9}); // used by nobody
  for (const auto& c : cube.corner) {
    for (const VertexId v : c) soup.position.push_back(cube.position[v]);
    const auto n = soup.vertex_count();
    soup.corner.push_back({VertexId(n - 3), VertexId(n - 2), VertexId(n - 1)});
    soup.part.push_back(static_cast<std::int32_t>(soup.corner.size()));
  }
  soup.position.push_back({-0.0, 0, 0}); // equal to a corner of the box
  const VertexId zero(soup.vertex_count() - 1);
  soup.corner.push_back({zero, VertexId(1u), VertexId(2u)}); // loses a corner: vertex 1 is (0, 0, 0) too
  soup.part.push_back(99);
  const TriMesh mesh = welded(soup);
  EXPECT_EQ(mesh.vertex_count(), 8u);
  ASSERT_EQ(mesh.triangle_count(), 12u);
  ASSERT_EQ(mesh.part.size(), 12u);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(mesh.part[TriangleId(i)], i + 1);
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 6);
  EXPECT_TRUE(surface_defects(mesh).clean());
}

TEST(SurfaceDefects, CleanSurfacesHaveNone) {
  for (const TriMesh& mesh : {cube, sphere_surface(3), together(cube, sphere_surface(2, 0.2, {0.5, 1, 1}))}) {
    const SurfaceDefects defects = surface_defects(mesh);
    EXPECT_TRUE(defects.clean()) << defects.summary();
    EXPECT_EQ(defects.summary(), "no defects");
    EXPECT_DOUBLE_EQ(defects.volume, signed_volume(mesh));
  }
  EXPECT_EQ(surface_defects(together(cube, sphere_surface(1, 0.2, {5, 5, 5}))).shells, 2u);
}

TEST(SurfaceDefects, CountsWhatIsPlanted) {
  TriMesh open = cube;
  open.corner.pop_back();
  SurfaceDefects defects = surface_defects(open);
  EXPECT_EQ(defects.border_edges, 3u);
  EXPECT_FALSE(defects.clean());

  TriMesh doubled = cube;
  doubled.corner.push_back(cube.corner[TriangleId(0u)]);
  defects = surface_defects(doubled);
  EXPECT_EQ(defects.duplicate_triangles, 1u);
  EXPECT_EQ(defects.non_manifold_edges, 3u);

  TriMesh turned = cube;
  std::swap(turned.corner[TriangleId(4u)][0], turned.corner[TriangleId(4u)][1]);
  EXPECT_EQ(surface_defects(turned).misoriented_edges, 3u);

  TriMesh flat = cube;
  flat.corner.push_back({VertexId(0u), VertexId(1u), VertexId(1u)});
  EXPECT_EQ(surface_defects(flat).degenerate_triangles, 1u);

  TriMesh broken = cube;
  broken.position[VertexId(3u)].x() = std::nan("");
  EXPECT_EQ(surface_defects(broken).non_finite_vertices, 1u);

  EXPECT_EQ(surface_defects(inside_out(cube)).inside_out_shells, 1u);
  // A cavity faces inwards and is no defect.
  EXPECT_EQ(surface_defects(together(cube, inside_out(sphere_surface(1, 0.2, {0.5, 1, 1})))).inside_out_shells, 0u);
  EXPECT_EQ(surface_defects(TriMesh()).summary(), "no triangles");
}

TEST(SurfaceDefects, FindsTouchingFansAndCrossings) {
  // Two boxes that share a corner, as one vertex.
  TriMesh touching = welded(together(cube, box_surface({1, 2, 3}, {2, 3, 4})));
  SurfaceDefects defects = surface_defects(touching);
  EXPECT_EQ(defects.non_manifold_vertices, 1u);
  EXPECT_EQ(defects.first_defect, Vec3d(1, 2, 3));
  EXPECT_EQ(defects.self_intersecting_triangles, 0u);

  const TriMesh crossing = together(cube, box_surface({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}));
  EXPECT_GT(surface_defects(crossing).self_intersecting_triangles, 4u);

  // A fold: two triangles over one edge, in one plane, on the same side.
  TriMesh fold;
  fold.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.5, 0}};
  fold.corner = {{VertexId(0u), VertexId(1u), VertexId(2u)}, {VertexId(1u), VertexId(0u), VertexId(3u)}};
  EXPECT_EQ(surface_defects(fold).self_intersecting_triangles, 2u);
  fold.position[VertexId(3u)] = {0.2, -0.5, 0};
  EXPECT_EQ(surface_defects(fold).self_intersecting_triangles, 0u);

  // Two that share a corner only, one piercing the other.
  TriMesh pierced;
  pierced.position = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 1, -1}, {0.1, 0.1, 2}};
  pierced.corner = {{VertexId(0u), VertexId(1u), VertexId(2u)}, {VertexId(0u), VertexId(3u), VertexId(4u)}};
  EXPECT_EQ(surface_defects(pierced).self_intersecting_triangles, 2u);
  pierced.position[VertexId(3u)] = {1, 1, 1};
  EXPECT_EQ(surface_defects(pierced).self_intersecting_triangles, 0u);
}

} // namespace
} // namespace pith
