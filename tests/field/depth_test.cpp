#include "volume/field/depth.h"
#include "volume/field/depth_extrema.h"

#include "tests/support/tet_grid.h"
#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/field/farthest_points.h"
#include "volume/field/polyline.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

using namespace pith;

namespace {

struct Scene {
  TetMesh mesh;
  Boundary boundary;
  explicit Scene(TetMesh m) : mesh(std::move(m)), boundary(boundary_of(mesh)) {}

  DepthField depth(const std::vector<DepthConstraint>& constraints, const DepthOptions& options = {}) const {
    return depth_field(mesh, boundary, 0, constraints, "fields.depth", options);
  }
};

const DepthConstraint skin_is_zero{.value = 0, .skin = true, .triangles = {}, .stroke = {}};

DepthConstraint stroke_of(std::vector<Vec3d> points, double value) {
  return {.value = value, .skin = false, .triangles = {}, .stroke = std::move(points)};
}

/// The message of the InvalidInput that depth_field throws; "" when it does not.
std::string refusal(const Scene& scene, const std::vector<DepthConstraint>& constraints) {
  try {
    scene.depth(constraints);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST(FarthestPoints, SpreadOverALine) {
  std::vector<Vec3d> points;
  for (int i = 0; i <= 8; ++i) points.push_back({double(i), 0, 0});
  EXPECT_EQ(farthest_points(points, 5), (std::vector<std::uint32_t>{0, 8, 4, 2, 6}));
  EXPECT_EQ(farthest_points(points, 3, 2), (std::vector<std::uint32_t>{0, 1, 8}));
  EXPECT_EQ(farthest_points(points, 100).size(), 9u);
  const std::vector<Vec3d> same(20, Vec3d(1, 2, 3));
  EXPECT_EQ(farthest_points(same, 5).size(), 1u);
}

TEST(Polyline, IsSampledAtEqualSteps) {
  const std::vector<Vec3d> corner = {{0, 0, 0}, {3, 0, 0}, {3, 0, 0}, {3, 1, 0}};
  const auto samples = evenly_sampled(corner, 1);
  ASSERT_EQ(samples.size(), 5u);
  EXPECT_LT((samples[2].point - Vec3d(2, 0, 0)).norm(), 1e-12);
  EXPECT_LT((samples[4].point - Vec3d(3, 1, 0)).norm(), 1e-12);
  EXPECT_EQ(samples[1].tangent, Vec3d(1, 0, 0));
  EXPECT_EQ(samples[4].tangent, Vec3d(0, 1, 0));
  EXPECT_EQ(evenly_sampled(std::vector<Vec3d>{{1, 1, 1}}, 1).size(), 1u);
}

TEST(Depth, OfABallIsRadialAndMonotone) {
  const Scene scene(tet_ball(12, 10));
  const DepthField field = scene.depth({skin_is_zero, stroke_of({{0, 0, 0}}, 1)});
  std::vector<std::pair<double, double>> by_radius;
  for (const VertexId v : all_ids<VertexId>(scene.mesh.vertex_count())) {
    const double r = scene.mesh.position[v].norm(), d = field.value[v];
    if (r > 10 - 1e-9) {
      EXPECT_EQ(d, 0);
    }
    if (r == 0) {
      EXPECT_EQ(d, 1);
    }
    EXPECT_GE(d, 0);
    EXPECT_LE(d, 1);
    by_radius.emplace_back(r, d);
  }
  std::sort(by_radius.begin(), by_radius.end());
  for (std::size_t i = 1; i < by_radius.size(); ++i) {
    // Equal radii have nearly equal depths, larger ones no greater.
    EXPECT_LE(by_radius[i].second, by_radius[i - 1].second + 0.012) << by_radius[i].first;
  }
  for (const TetId t : all_ids<TetId>(scene.mesh.tet_count())) {
    const Vec3d x = barycenter(scene.mesh, t), g = field.gradient[t];
    EXPECT_GT(g.norm(), 1e-3);
    EXPECT_GT(-g.normalized().dot(x.normalized()), std::cos(3 * M_PI / 180)) << x.transpose();
  }
}

// Between two opposite sides of a box the smoothest interpolant is linear: the kernel's weights vanish.
TEST(Depth, BetweenOppositeSidesIsLinear) {
  TetMesh mesh = tet_grid(6, 5, 4, 2);
  Boundary boundary = boundary_of(mesh);
  std::vector<TriangleId> low, high;
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) {
    boundary.input.push_back(TriangleId(f.value));
    const auto on = [&](double x) {
      return std::all_of(boundary.corner[f].begin(), boundary.corner[f].end(),
                         [&](VertexId v) { return mesh.position[v].x() == x; });
    };
    if (on(0)) low.push_back(TriangleId(f.value));
    if (on(12)) high.push_back(TriangleId(f.value));
  }
  const DepthField field = depth_field(mesh, boundary, 0,
                                       {{.value = 0.25, .skin = false, .triangles = low, .stroke = {}},
                                        {.value = 0.75, .skin = false, .triangles = high, .stroke = {}}},
                                       "depth");
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count()))
    EXPECT_NEAR(field.value[v], 0.25 + mesh.position[v].x() / 24, 1e-6);
  for (const Vec3d& g : field.gradient) EXPECT_LT((g - Vec3d(1. / 24, 0, 0)).norm(), 1e-8);
}

TEST(Depth, GradientIsThatOfTheVertices) {
  const Scene scene(tet_ball(16, 10));
  const DepthField field = scene.depth({skin_is_zero, stroke_of({{0, 0, -4}, {0, 0, 4}}, 1)});
  int compared = 0;
  for (const TetId t : all_ids<TetId>(scene.mesh.tet_count())) {
    const Vec3d x = barycenter(scene.mesh, t);
    if (x.norm() > 8 || x.head<2>().norm() < 3) continue; // away from clamping and from thinned constraints
    const auto& corner = scene.mesh.corner[t];
    Mat3d edges;
    Vec3d rise;
    for (int k = 0; k < 3; ++k) {
      edges.row(k) = scene.mesh.position[corner[k + 1]] - scene.mesh.position[corner[0]];
      rise[k] = field.value[corner[k + 1]] - field.value[corner[0]];
    }
    const Mat3d adjugate = (Mat3d() << edges.row(1).transpose().cross(edges.row(2).transpose()),
                            edges.row(2).transpose().cross(edges.row(0).transpose()),
                            edges.row(0).transpose().cross(edges.row(1).transpose()))
                               .finished();
    const Vec3d linear = adjugate * rise / edges.row(0).dot(edges.row(1).transpose().cross(edges.row(2).transpose()));
    EXPECT_LT((linear - field.gradient[t]).norm(), 0.15 * field.gradient[t].norm());
    ++compared;
  }
  EXPECT_GT(compared, 500);
}

TEST(Depth, VerticesOnAStrokeAreExact) {
  const Scene scene(tet_ball(8, 10));
  const DepthField field = scene.depth({skin_is_zero, stroke_of({{0, 0, -5}, {0, 0, 5}}, 1)});
  int on_stroke = 0;
  for (const VertexId v : all_ids<VertexId>(scene.mesh.vertex_count())) {
    const Vec3d& x = scene.mesh.position[v];
    if (x.x() != 0 || x.y() != 0 || std::abs(x.z()) > 5) continue;
    EXPECT_EQ(field.value[v], 1.0f);
    ++on_stroke;
  }
  EXPECT_EQ(on_stroke, 5);
}

// Thinning must change little, and thinned vertices keep their depths to the bit.
// Beside a core that does not lie in the middle the thin plate rises beyond 1.
TEST(Depth, GuardsHoldItInBounds) {
  const Scene scene(tet_grid(16, 16, 16));
  const std::vector<DepthConstraint> constraints = {skin_is_zero, stroke_of({{4, 8, 2}, {4, 8, 14}}, 1)};
  const auto plateau = [&](const DepthField& field) {
    const PerVertex<std::uint8_t> held = constrained_vertices(scene.mesh, scene.boundary, 0, constraints, "depth");
    std::size_t count = 0;
    for (const VertexId v : all_ids<VertexId>(scene.mesh.vertex_count())) {
      EXPECT_TRUE(field.value[v] >= 0 && field.value[v] <= 1);
      count += !held[v] && field.value[v] > 0.999f;
    }
    return count;
  };
  const DepthField paper = scene.depth(constraints), ours = scene.depth(constraints, {.guard_overshoot = true});
  EXPECT_GT(plateau(paper), 100u);
  EXPECT_EQ(plateau(ours), 0u);
  EXPECT_GT(ours.centers, paper.centers);
  for (const VertexId v : all_ids<VertexId>(scene.mesh.vertex_count())) {
    const Vec3d& x = scene.mesh.position[v];
    const bool on_stroke = x.x() == 4 && x.y() == 8 && x.z() >= 2 && x.z() <= 14;
    EXPECT_TRUE(!on_stroke || ours.value[v] == 1) << x.transpose();
  }
  for (const TetId t : all_ids<TetId>(scene.mesh.tet_count())) { // towards the core, beside it
    const Vec3d x = barycenter(scene.mesh, t);
    const bool beside = x.x() > 6 && x.x() < 15 && std::abs(x.y() - 8) < 3 && x.z() > 3 && x.z() < 13;
    EXPECT_TRUE(!beside || ours.gradient[t].x() < 0) << x.transpose();
  }

  // Where nothing overshoots there is nothing to guard.
  const std::vector<DepthConstraint> middle = {skin_is_zero, stroke_of({{8, 8, 8}}, 1)};
  EXPECT_EQ(scene.depth(middle, {.guard_overshoot = true}).value, scene.depth(middle).value);
}

TEST(Depth, ThinningChangesLittle) {
  const Scene scene(tet_ball(16, 10));
  const std::vector<DepthConstraint> constraints = {skin_is_zero, stroke_of({{0, 0, -4}, {0, 0, 4}}, 1)};
  const DepthField fine = scene.depth(constraints, {.max_centers = 3000}), coarse = scene.depth(constraints);
  EXPECT_GT(fine.centers, 1500u);
  EXPECT_LE(coarse.centers, 500u);
  for (const auto& corner : scene.boundary.corner)
    for (const VertexId v : corner) EXPECT_EQ(coarse.value[v], 0.0f);
  for (const VertexId v : all_ids<VertexId>(scene.mesh.vertex_count()))
    EXPECT_NEAR(fine.value[v], coarse.value[v], 0.004);
}

TEST(Depth, IsTheSameOnAnyNumberOfThreads) {
  const Scene scene(tet_ball(10, 10));
  const std::vector<DepthConstraint> constraints = {skin_is_zero, stroke_of({{0, 0, -4}, {0, 1, 4}}, 1)};
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return scene.depth(constraints, {.max_centers = 200});
  };
  const DepthField one = run(1), two = run(2);
  EXPECT_EQ(one.value, two.value);
  EXPECT_EQ(one.gradient, two.gradient);
}

TEST(Depth, KeepsToItsRegion) {
  TetMesh mesh = tet_grid(8, 4, 4);
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) mesh.region[t] = barycenter(mesh, t).x() < 4 ? 0 : 1;
  const Scene scene(std::move(mesh));
  const DepthConstraint core = stroke_of({{2, 2, 2}}, 1);
  EXPECT_NE(refusal(scene, {skin_is_zero, stroke_of({{6, 2, 2}}, 1)}).find("misses region 0"), std::string::npos);
  const DepthField field = scene.depth({skin_is_zero, core});
  for (const TetId t : all_ids<TetId>(scene.mesh.tet_count()))
    EXPECT_EQ(field.gradient[t] == Vec3d::Zero(), scene.mesh.region[t] == 1);
  for (const VertexId v : all_ids<VertexId>(scene.mesh.vertex_count())) {
    const Vec3d& x = scene.mesh.position[v];
    if (x.x() >= 4) { // the interface is skin, the rest is not this region's
      EXPECT_EQ(field.value[v], 0.0f);
    }
    if (x == Vec3d(2, 2, 2)) {
      EXPECT_EQ(field.value[v], 1.0f);
    }
    if (x == Vec3d(3, 2, 2)) {
      EXPECT_GT(field.value[v], 0.2f);
    }
  }
}

// The faces of a box end at its edges; a bar of wedges with flat creases is one face.
TEST(Depth, FillsFacesUpToCreases) {
  TetMesh mesh = tet_grid(6, 5, 4, 2);
  Boundary boundary = boundary_of(mesh);
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) boundary.input.push_back(TriangleId(f.value));
  const auto fill = [](const Vec3d& at, double crease, double value) {
    DepthConstraint constraint{.value = value, .skin = false, .triangles = {}, .stroke = {}};
    constraint.fill = FaceFill{.near = at, .triangle = {}, .crease = crease};
    return constraint;
  };
  const DepthField field =
      depth_field(mesh, boundary, 0, {fill({0, 5, 4}, 0.6, 0.25), fill({12, 5, 4}, 0.6, 0.75)}, "depth");
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count()))
    EXPECT_NEAR(field.value[v], 0.25 + mesh.position[v].x() / 24, 1e-6);
  // The same from triangles, and by hand.
  DepthConstraint from_triangle = fill(Vec3d::Zero(), 0.6, 0.25);
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count()))
    if (std::all_of(boundary.corner[f].begin(), boundary.corner[f].end(),
                    [&](VertexId v) { return mesh.position[v].x() == 0; }))
      from_triangle.fill->triangle = boundary.input[f];
  const DepthField again = depth_field(mesh, boundary, 0, {from_triangle, fill({12, 5, 4}, 0.6, 0.75)}, "depth");
  EXPECT_EQ(again.value, field.value);
  // Wide enough, the fill runs around the box's edges and meets the other one.
  EXPECT_THROW(depth_field(mesh, boundary, 0, {fill({0, 5, 4}, 1.6, 0.25), fill({12, 5, 4}, 0.6, 0.75)}, "depth"),
               InvalidInput);
  EXPECT_THROW(depth_field(mesh, boundary, 0, {fill({6, 5, 4}, 0.6, 0.25), fill({12, 5, 4}, 0.6, 0.75)}, "depth"),
               InvalidInput); // starts inside
}

// All places as centres agree with thinned ones where those are good.
TEST(Depth, AllConstraintsAgreeWithSome) {
  const Scene scene(tet_ball(20, 10));
  const std::vector<DepthConstraint> constraints = {skin_is_zero, stroke_of({{0, 0, -4}, {0, 0, 4}}, 1)};
  const DepthField all = scene.depth(constraints, {.max_centers = 100'000}),
                   some = scene.depth(constraints, {.max_centers = 1000});
  EXPECT_GT(all.centers, 2000u);
  EXPECT_LE(some.centers, 1000u);
  for (const VertexId v : all_ids<VertexId>(scene.mesh.vertex_count()))
    EXPECT_NEAR(all.value[v], some.value[v], 0.004);
}

TEST(Depth, RefusesContradictionsAndNamesThePlace) {
  const Scene scene(tet_ball(6, 10));
  const DepthConstraint axis = stroke_of({{0, 0, -4}, {0, 0, 4}}, 1);
  const auto expect = [&](const std::vector<DepthConstraint>& constraints, const std::string& part) {
    const std::string message = refusal(scene, constraints);
    EXPECT_EQ(message.rfind("fields.depth", 0), 0u) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  };
  EXPECT_EQ(refusal(scene, {skin_is_zero, axis}), "");
  expect({}, "no depth constraint");
  expect({skin_is_zero}, "have the value 0");
  expect({skin_is_zero, stroke_of({{0, 0, 0}}, 0)}, "have the value 0");
  expect({skin_is_zero, stroke_of({{0, 0, 0}}, 1.5)}, "fields.depth[1]: depth 1.5 lies outside");
  expect({skin_is_zero, stroke_of({{0, 0, 0}}, std::nan(""))}, "lies outside");
  expect({skin_is_zero, {.value = 1, .skin = true, .triangles = {}, .stroke = {}}}, "two constraints ask");
  expect({skin_is_zero, stroke_of({{0, 0, 0}, {0, 0, 10}}, 1)}, "two constraints ask");       // ends on the skin
  expect({skin_is_zero, stroke_of({{0, 0.1, 0}, {0.1, 0.3, 30}}, 1)}, "two constraints ask"); // runs through it
  expect({stroke_of({{0, -4, 0}, {0, 0, 0}, {0, 4, 0}}, 0), axis}, "two constraints ask");    // crossing strokes
  expect({skin_is_zero, stroke_of({{30, 0, 0}, {30, 5, 0}}, 1)}, "fields.depth[1]: the stroke");
  expect({skin_is_zero, stroke_of({{0, 0, 0}, {NAN, 5, 0}}, 1)}, "not finite");
  expect({skin_is_zero, {.value = 1, .skin = false, .triangles = {}, .stroke = {}}}, "names no place");
  expect({skin_is_zero, {.value = 1, .skin = false, .triangles = {TriangleId(0)}, .stroke = {}}}, "input triangles");
  EXPECT_THROW(depth_field(scene.mesh, scene.boundary, 7, {skin_is_zero, axis}, "x"), InvalidInput);
  EXPECT_THROW(scene.depth({skin_is_zero, axis}, {.max_centers = 2}), InvalidInput);
}

TEST(Polyline, ALengthBeyondDoublesIsRefused) {
  const std::vector<Vec3d> stroke = {{0, 0, -1e200}, {0, 0, 1e200}};
  EXPECT_THROW(evenly_sampled(stroke, 1), InvalidInput);
  EXPECT_THROW(evenly_sampled(std::vector<Vec3d>{{0, 0, 0}, {0, std::nan(""), 0}}, 1), InvalidInput);
}
