// Dividing meshes: nothing is lost, nothing overlaps, every point is on its side.
#include "tests/support/tet_grid.h"
#include "tests/support/tri_shapes.h"
#include "volume/base/error.h"
#include "volume/base/random.h"
#include "volume/cut/cut.h"
#include "volume/cut/divide.h"
#include "volume/mesh/locate.h"
#include "volume/mesh/orientation.h"
#include "volume/mesh/region_measure.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>

namespace pith {
namespace {

/// Each facet of the boundary is a triangle of its own.
Indexed<FacetId, TriangleId> own_triangles(const TetMesh& mesh) {
  Indexed<FacetId, TriangleId> input;
  for (const FacetId f : all_ids<FacetId>(boundary_of(mesh).facet_count())) input.push_back(TriangleId(f.value));
  return input;
}

double volume_of(const TetMesh& mesh) {
  double sum = 0;
  for (const RegionMeasure& region : measure_regions(mesh)) sum += region.volume;
  return sum;
}

std::map<std::int32_t, RegionMeasure> regions_of(const TetMesh& mesh) {
  std::map<std::int32_t, RegionMeasure> result;
  for (const RegionMeasure& region : measure_regions(mesh)) result[region.region] = region;
  return result;
}

/// Valid and connected, all tets positive by exact signs, every facet of two tets or, on the outside, of one; the
/// outside is covered by the facets of the mesh before, each inside the triangle that it says it came from.
void check_divided(const TetMesh& before, const DivideResult& result) {
  const TetMesh& mesh = result.mesh;
  validate(mesh);
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
    const auto& c = mesh.corner[t];
    ASSERT_GT(orientation(mesh.position[c[0]], mesh.position[c[1]], mesh.position[c[2]], mesh.position[c[3]]), 0);
  }
  std::map<std::array<std::uint32_t, 3>, int> uses;
  for (const auto& corner : mesh.corner)
    for (int i = 0; i < 4; ++i) {
      std::array<std::uint32_t, 3> key;
      for (int k = 0; k < 3; ++k) key[k] = corner[facet_corners[i][k]];
      std::sort(key.begin(), key.end());
      ++uses[key];
    }
  EXPECT_NEAR(volume_of(mesh), volume_of(before), 1e-12 * volume_of(before));

  const Boundary old_boundary = boundary_of(before), boundary = boundary_of(mesh);
  ASSERT_EQ(result.input.size(), boundary.facet_count());
  std::vector<double> covered(old_boundary.facet_count(), 0);
  std::set<std::int32_t> made;
  for (const auto& split : result.split) made.insert(split.right);
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) {
    const TetId t = boundary.tet[f], behind = boundary.behind[f];
    std::array<std::uint32_t, 3> key = {boundary.corner[f][0], boundary.corner[f][1], boundary.corner[f][2]};
    std::sort(key.begin(), key.end());
    ASSERT_EQ(uses[key], behind.exists() ? 2 : 1);
    std::array<Vec3d, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = mesh.position[boundary.corner[f][k]];
    if (!result.input[f].exists()) {
      EXPECT_TRUE(behind.exists() && made.contains(std::max(mesh.region[t], mesh.region[behind])));
      continue;
    }
    std::array<Vec3d, 3> q;
    for (int k = 0; k < 3; ++k) q[k] = before.position[old_boundary.corner[FacetId(result.input[f].value)][k]];
    for (const Vec3d& x : p) EXPECT_LT(closest_point(q, x).squared_distance, 1e-20);
    covered[result.input[f]] += 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
  }
  for (const FacetId f : all_ids<FacetId>(old_boundary.facet_count())) {
    std::array<Vec3d, 3> q;
    for (int k = 0; k < 3; ++k) q[k] = before.position[old_boundary.corner[f][k]];
    EXPECT_NEAR(covered[f], 0.5 * (q[1] - q[0]).cross(q[2] - q[0]).norm(), 1e-9);
  }
}

/// How many of 100,000 random points lie in the wrong one of two regions; points within `margin` of the level set do
/// not count.
int on_wrong_side(const TetMesh& mesh, const LevelSet& level_set, std::int32_t left, std::int32_t right,
                  double margin) {
  const Boundary boundary = boundary_of(mesh);
  const Locator locator(mesh, boundary);
  const Box box = bounds_of(mesh);
  int wrong = 0, seen = 0;
  Random random(7, 3);
  for (int i = 0; i < 100'000; ++i) {
    const Vec3d x(random.uniform(box.low.x(), box.high.x()), random.uniform(box.low.y(), box.high.y()),
                  random.uniform(box.low.z(), box.high.z()));
    const TetId t = locator.owner(x);
    const double value = level_set.value(x);
    if (!t.exists() || std::abs(value) < margin || (mesh.region[t] != left && mesh.region[t] != right)) continue;
    ++seen;
    wrong += (value > 0 ? right : left) != mesh.region[t];
  }
  EXPECT_GT(seen, 10'000);
  return wrong;
}

TEST(Divide, PartsABoxByAPlaneExactly) {
  const TetMesh box = tet_grid(8, 7, 6, 1.5);
  for (const double snap : {0.0, 0.2, 0.4})
    for (const Vec3d& normal : {Vec3d(0, 0, 1), Vec3d(0.1, 0.2, 1), Vec3d(1, 1, 1)}) {
      const auto plane = level_set_of(PlaneCut{normal, 4.0 * normal.norm()});
      const DivideResult result = divide(box, own_triangles(box), *plane, {.only = {}, .snap = snap});
      check_divided(box, result);
      ASSERT_EQ(result.split.size(), 1u);
      EXPECT_EQ(result.split[0].left, 0);
      EXPECT_EQ(result.split[0].right, 1);
      // Boundary vertices that count as on the plane are off it by at most snap/4 of an edge of 1.5 mm.
      EXPECT_EQ(on_wrong_side(result.mesh, *plane, 0, 1, 1e-9 + 0.25 * snap * 1.5), 0);
    }
}

TEST(Divide, FlatLayersHaveTheirVolumes) {
  const TetMesh box = tet_grid(8, 8, 8);
  const auto plane = level_set_of(PlaneCut{{0, 0, 1}, 3.3});
  const DivideResult result = divide(box, {}, *plane);
  const auto regions = regions_of(result.mesh);
  EXPECT_NEAR(regions.at(0).volume, 64 * 3.3, 1e-9);
  EXPECT_NEAR(regions.at(1).volume, 64 * 4.7, 1e-9);
  EXPECT_NEAR(regions.at(1).interface_area, 64, 1e-9);
  EXPECT_NEAR(regions.at(1).outside_area, 64 + 4 * 8 * 4.7, 1e-9);
  EXPECT_TRUE(result.input.empty());
  EXPECT_GT(std::min(regions.at(0).minimum_dihedral, regions.at(1).minimum_dihedral), 0.1);
}

TEST(Divide, AlongFacesOfTheMeshNothingIsCut) {
  const TetMesh box = tet_grid(4, 4, 4);
  const DivideResult result = divide(box, own_triangles(box), *level_set_of(PlaneCut{{0, 0, 1}, 2}));
  check_divided(box, result);
  EXPECT_EQ(result.tets_cut, 0u);
  EXPECT_EQ(result.mesh.position, box.position);
  EXPECT_NEAR(regions_of(result.mesh).at(1).volume, 32, 1e-12);
}

TEST(Divide, CurvedAndWavyLevelSetsAndABall) {
  const TetMesh ball = tet_ball(9, 10.0);
  const std::vector<std::unique_ptr<LevelSet>> shapes = [] {
    std::vector<std::unique_ptr<LevelSet>> all;
    all.push_back(level_set_of(SphereCut{{2, 1, 0}, 5}));
    all.push_back(level_set_of(PlaneCut{{0.2, 0, 1}, 1, {1.5, 8, 4}}));
    all.push_back(level_set_of(
        StrokeCut{{{-1, 0.1}, {-0.3, -0.05}, {0.3, 0.12}, {1, 0}}, View{{0, -40, 0}, {0, 0, 0}, {0, 0, 1}}}));
    return all;
  }();
  for (const auto& shape : shapes)
    for (const double snap : {0.0, 0.2}) {
      const DivideResult result = divide(ball, own_triangles(ball), *shape, {.only = {}, .snap = snap});
      check_divided(ball, result);
      // The interface is flat between its vertices: what it leaves out is a curve's sagitta.
      EXPECT_EQ(on_wrong_side(result.mesh, *shape, 0, 1, 0.6), 0);
      EXPECT_EQ(result.moved > 0, snap > 0);
    }
}

TEST(Divide, ASurfaceMeshParts) {
  // A closed box with sharp edges and corners: the sign is exact everywhere.
  const TriMesh box = testing::box_surface({2.2, 2.1, 2.3}, {5.8, 5.7, 5.9});
  const auto inside = level_set_of(box);
  Random random(3, 1);
  for (int i = 0; i < 20'000; ++i) {
    const Vec3d x(random.uniform(0, 8), random.uniform(0, 8), random.uniform(0, 8));
    const Vec3d out = (Vec3d(2.2, 2.1, 2.3) - x).cwiseMax(x - Vec3d(5.8, 5.7, 5.9));
    const double expected = out.maxCoeff() <= 0 ? out.maxCoeff() : out.cwiseMax(0).norm();
    EXPECT_NEAR(inside->value(x), expected, 1e-12);
  }
  const TetMesh grid = tet_grid(16, 16, 16, 0.5);
  const DivideResult result = divide(grid, own_triangles(grid), *inside);
  check_divided(grid, result);
  EXPECT_NEAR(regions_of(result.mesh).at(0).volume, 3.6 * 3.6 * 3.6, 0.06 * 3.6 * 3.6 * 3.6); // its edges are blunted

  // An open sheet: two triangles in the plane z = 3.4 that end inside the grid; it goes on beyond its rim.
  TriMesh sheet;
  sheet.position = {{1, 1, 3.4}, {7, 1, 3.4}, {7, 7, 3.4}, {1, 7, 3.4}};
  sheet.corner = {{VertexId(0), VertexId(1), VertexId(2)}, {VertexId(0), VertexId(2), VertexId(3)}};
  const auto above = level_set_of(sheet);
  const DivideResult layers = divide(grid, own_triangles(grid), *above);
  check_divided(grid, layers);
  EXPECT_EQ(on_wrong_side(layers.mesh, *level_set_of(PlaneCut{{0, 0, 1}, 3.4}), 0, 1, 0.06), 0);
  EXPECT_THROW(level_set_of(TriMesh{}), InvalidInput);
}

TEST(Divide, MovingVerticesMakesBetterTets) {
  const TetMesh ball = tet_ball(9, 10.0);
  const auto shape = level_set_of(PlaneCut{{0.31, 0.2, 1}, 0.4, {1.5, 9, 2}});
  const auto worst = [&](double snap) {
    double least = 4;
    for (const RegionMeasure& region : measure_regions(divide(ball, {}, *shape, {.only = {}, .snap = snap}).mesh))
      least = std::min(least, region.minimum_dihedral);
    return least;
  };
  EXPECT_GT(worst(0.2), 5 * worst(0));
}

TEST(Divide, CrossingDividesNumberTheirRegionsAscending) {
  const TetMesh ball = tet_ball(9, 10.0);
  const auto first = level_set_of(PlaneCut{{0, 0, 1}, 1, {1, 9, 3}}),
             second = level_set_of(PlaneCut{{1, 0.1, 0}, -0.7});
  const DivideResult one = divide(ball, own_triangles(ball), *first);
  const DivideResult two = divide(one.mesh, one.input, *second);
  const DivideResult again = divide(one.mesh, own_triangles(one.mesh), *second);
  check_divided(one.mesh, again);
  ASSERT_EQ(two.split.size(), 2u);
  EXPECT_EQ(two.split[0].left, 0);
  EXPECT_EQ(two.split[0].right, 2);
  EXPECT_EQ(two.split[1].left, 1);
  EXPECT_EQ(two.split[1].right, 3);
  for (const auto& [left, right] : {std::pair(0, 2), std::pair(1, 3)})
    EXPECT_EQ(on_wrong_side(two.mesh, *second, left, right, 0.15), 0);
  for (const auto& [left, right] : {std::pair(0, 1), std::pair(2, 3)})
    EXPECT_EQ(on_wrong_side(two.mesh, *first, left, right, 0.6), 0);
  EXPECT_NEAR(volume_of(two.mesh), volume_of(ball), 1e-12 * volume_of(ball));
  // Triangles come through both divides.
  const Boundary boundary = boundary_of(two.mesh);
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count()))
    EXPECT_EQ(two.input[f].exists(), !boundary.behind[f].exists());
}

TEST(Divide, OnlyTheNamedRegionIsPartedAndTheMeshStaysConforming) {
  const TetMesh box = tet_grid(8, 8, 8);
  const DivideResult layers = divide(box, own_triangles(box), *level_set_of(PlaneCut{{0, 0, 1}, 4.2}));
  const auto across = level_set_of(PlaneCut{{1, 0.2, 0.1}, 4.3});
  const DivideResult upper = divide(layers.mesh, own_triangles(layers.mesh), *across, {.only = {1}});
  check_divided(layers.mesh, upper);
  ASSERT_EQ(upper.split.size(), 1u);
  EXPECT_EQ(upper.split[0].left, 1);
  EXPECT_EQ(upper.split[0].right, 2);
  const auto before = regions_of(layers.mesh), after = regions_of(upper.mesh);
  EXPECT_NEAR(after.at(0).volume, before.at(0).volume, 1e-10);
  EXPECT_NEAR(after.at(1).volume + after.at(2).volume, before.at(1).volume, 1e-10);
  EXPECT_EQ(on_wrong_side(upper.mesh, *across, 1, 2, 0.06), 0);
  EXPECT_GT(after.at(0).tets, before.at(0).tets); // split beside the new interface
}

TEST(Divide, ACutThroughLayersKeepsThemApart) {
  const TetMesh ball = tet_ball(9, 10.0);
  const TetMesh mesh = divide(ball, {}, *level_set_of(PlaneCut{{0, 0, 1}, 1, {1, 9, 3}})).mesh;
  const Boundary boundary = boundary_of(mesh);
  Pieces pieces = whole_piece(mesh);
  cut(pieces, mesh, boundary, *level_set_of(PlaneCut{{1, 0.2, 0}, 0.4}));
  ASSERT_EQ(pieces.piece.size(), 2u);
  double all = 0;
  for (std::uint32_t p = 0; p < 2; ++p) {
    all += measure(pieces, p, mesh).volume;
    // No interface inside a piece is part of its surface; the section has triangles of both layers.
    std::set<std::int32_t> on_section;
    for (const auto& triangle : surface_of(pieces, p, mesh, boundary).triangle) {
      EXPECT_FALSE(triangle.tag.is_skin() && boundary.behind[triangle.tag.facet()].exists());
      if (triangle.tag.is_section()) on_section.insert(mesh.region[triangle.root]);
    }
    EXPECT_EQ(on_section, (std::set<std::int32_t>{0, 1}));
  }
  EXPECT_NEAR(all, volume_of(ball), 1e-10 * volume_of(ball));
}

TEST(Divide, SaysWhatIsWrong) {
  const TetMesh box = tet_grid(4, 4, 4);
  const auto message = [&](const PlaneCut& plane, const DivideOptions& options) -> std::string {
    try {
      divide(box, {}, *level_set_of(plane), options, "cake.json: /divide/0");
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(
      message({{0, 0, 1}, 9, {}}, {}).find("cake.json: /divide/0: divides no region: the level set runs from -9"),
      std::string::npos);
  EXPECT_NE(message({{0, 0, 1}, 4, {}}, {}).find("divides no region"), std::string::npos); // touches
  EXPECT_NE(message({{0, 0, 1}, 9, {}}, {.only = {0}}).find("misses region 0"), std::string::npos);
  EXPECT_NE(
      message({{0, 0, 1}, 2, {}}, {.only = {3}}).find("/divide/0/only: there is no region 3; the regions here are 0"),
      std::string::npos);
  EXPECT_NE(message({{0, 0, 1}, 2, {}}, {.only = {}, .snap = 0.6}).find("snap"), std::string::npos);
}

TEST(WavyPlane, StaysWithinItsAmplitudeAndKnowsItsGradient) {
  const PlaneCut plane{{1, 2, 3}, 5, {2.5, 12, 9}};
  const auto wavy = level_set_of(plane), flat = level_set_of(PlaneCut{plane.normal, plane.offset});
  const auto other = level_set_of(PlaneCut{plane.normal, plane.offset, {2.5, 12, 10}});
  Random random(1, 2);
  double most = 0, squares = 0, difference = 0;
  const int points = 20'000;
  for (int i = 0; i < points; ++i) {
    const Vec3d x(random.uniform(-200, 200), random.uniform(-200, 200), random.uniform(-200, 200));
    const double height = flat->value(x) - wavy->value(x);
    most = std::max(most, std::abs(height));
    squares += height * height;
    difference = std::max(difference, std::abs(other->value(x) - wavy->value(x)));
    // The wave depends on the place along the plane alone, and planes of one seed never meet.
    EXPECT_NEAR(wavy->value(x + 7 * plane.normal.normalized()), wavy->value(x) + 7, 1e-9);
    const Vec3d gradient = wavy->gradient(x);
    EXPECT_GE(gradient.norm(), 1 - 1e-12);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3d step = 1e-5 * Vec3d::Unit(axis);
      EXPECT_NEAR((wavy->value(x + step) - wavy->value(x - step)) / 2e-5, gradient[axis], 1e-6);
    }
  }
  EXPECT_LE(most, 2.5);
  EXPECT_GT(most, 2.0);
  EXPECT_GT(std::sqrt(squares / points), 1.0); // it is no ripple
  EXPECT_GT(difference, 2.5);                  // another seed, other waves
  EXPECT_FALSE(wavy->linear());
  EXPECT_THROW(level_set_of(PlaneCut{{0, 0, 1}, 0, {-1, 10, 1}}), InvalidInput);
  EXPECT_THROW(level_set_of(PlaneCut{{0, 0, 1}, 0, {1, 0, 1}}), InvalidInput);
}

} // namespace
} // namespace pith
