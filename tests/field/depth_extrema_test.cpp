#include "volume/field/depth_extrema.h"

#include "tests/support/shared_data.h"
#include "tests/support/tet_grid.h"
#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/field/frames.h"
#include "volume/io/mesh_io.h"
#include "volume/mesh/tetrahedralize.h"

#include <cstdio>
#include <gtest/gtest.h>

using namespace pith;

namespace {

const DepthConstraint skin_is_zero{.value = 0, .skin = true, .triangles = {}, .stroke = {}};

/// A boundary vertex counts as free, unless a constraint holds it.
std::vector<DepthExtremum> extrema_in(const TetMesh& mesh, const Boundary& boundary, const DepthField& field,
                                      const std::vector<DepthConstraint>& constraints, double persistence = 0.01) {
  return extrema_of(mesh, 0, field.value, constrained_vertices(mesh, boundary, 0, constraints, "depth"), persistence);
}

/// The vertex farthest from the boundary.
Vec3d innermost(const TetMesh& mesh, const Boundary& boundary) {
  std::vector<std::uint8_t> skin(mesh.vertex_count(), 0);
  for (const auto& corner : boundary.corner)
    for (const VertexId v : corner) skin[v] = 1;
  std::vector<double> distance(mesh.vertex_count(), -1);
  parallel_for(mesh.vertex_count(), 16, [&](std::size_t v) {
    if (skin[v]) return;
    double least = 1e300;
    for (const VertexId w : all_ids<VertexId>(mesh.vertex_count()))
      if (skin[w]) least = std::min(least, (mesh.position[VertexId(v)] - mesh.position[w]).squaredNorm());
    distance[v] = least;
  });
  return mesh.position[VertexId(std::max_element(distance.begin(), distance.end()) - distance.begin())];
}

struct Concave {
  const char* file;
  double scale; ///< to about 100 mm
};

class ConcaveMeshes : public ::testing::TestWithParam<Concave> {};

} // namespace

TEST(DepthExtrema, AreFoundWithTheirPersistence) {
  const TetMesh mesh = tet_grid(12, 6, 6);
  PerVertex<float> depth(mesh.vertex_count());
  const auto bump = [](const Vec3d& x, const Vec3d& at, double height) {
    return height * std::max(0.0, 1 - (x - at).norm() / 2.5);
  };
  const Vec3d held(3, 3, 3), free(9, 3, 3);
  PerVertex<std::uint8_t> constrained(mesh.vertex_count(), 0);
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count())) {
    const Vec3d& x = mesh.position[v];
    depth[v] = static_cast<float>(0.1 + bump(x, held, 0.8) + bump(x, free, 0.5));
    constrained[v] = x == held || x.x() == 0;
  }
  const auto found = extrema_of(mesh, 0, depth, constrained);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].place, free);
  EXPECT_TRUE(found[0].maximum);
  EXPECT_NEAR(found[0].persistence, 0.5, 1e-6);
  EXPECT_NEAR(found[0].depth, 0.6, 1e-6);
  EXPECT_TRUE(extrema_of(mesh, 0, depth, constrained, 0.51).empty());
  for (float& d : depth) d = 1 - d; // minima are found alike
  const auto turned = extrema_of(mesh, 0, depth, constrained);
  ASSERT_EQ(turned.size(), 1u);
  EXPECT_FALSE(turned[0].maximum);
  EXPECT_EQ(turned[0].place, free);
}

// A plateau is one extremum, and none where it touches a constraint.
TEST(DepthExtrema, OfAPlateauIsOne) {
  const TetMesh mesh = tet_grid(10, 4, 4);
  PerVertex<float> depth(mesh.vertex_count(), 0.0f);
  PerVertex<std::uint8_t> constrained(mesh.vertex_count(), 0);
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count())) {
    if (mesh.position[v].x() >= 6) depth[v] = 0.5f;
    constrained[v] = mesh.position[v].x() == 0;
  }
  EXPECT_EQ(extrema_of(mesh, 0, depth, constrained).size(), 1u);
  constrained[VertexId(mesh.vertex_count() - 1)] = 1;
  EXPECT_TRUE(extrema_of(mesh, 0, depth, constrained).empty());
}

TEST(DepthExtrema, AnUndisturbedBallHasNone) {
  const TetMesh mesh = tet_ball(12, 10);
  const Boundary boundary = boundary_of(mesh);
  const std::vector<DepthConstraint> constraints = {
      skin_is_zero, {.value = 1, .skin = false, .triangles = {}, .stroke = {{0, 0, -4}, {0, 0, 4}}}};
  const DepthField field = depth_field(mesh, boundary, 0, constraints, "depth"),
                   paper = depth_field(mesh, boundary, 0, constraints, "depth", {.remove_extrema = false});
  EXPECT_EQ(field.extrema, 0u);
  EXPECT_EQ(field.value, paper.value);
}

// A bar whose constraints stand close together at one end: the thin plate goes on falling beyond them.
TEST(DepthExtrema, AreTakenAwayBeyondTheLastConstraint) {
  const TetMesh mesh = tet_grid(24, 4, 4);
  const Boundary boundary = boundary_of(mesh);
  const auto across = [](double x, double value) {
    return DepthConstraint{
        .value = value, .skin = false, .triangles = {}, .stroke = {{x, 0, 2}, {x, 2, 2}, {x, 2, 4}, {x, 4, 0}}};
  };
  const std::vector<DepthConstraint> constraints = {across(1, 0.2), across(6, 1), across(10, 0.7)};
  const DepthField paper = depth_field(mesh, boundary, 0, constraints, "depth", {.remove_extrema = false}),
                   ours = depth_field(mesh, boundary, 0, constraints, "depth");
  EXPECT_GT(extrema_in(mesh, boundary, paper, constraints).size(), 0u);
  EXPECT_EQ(paper.extrema, ours.extrema);
  const auto after = extrema_in(mesh, boundary, ours, constraints);
  EXPECT_TRUE(after.empty()) << after.size() << " left, the worst persists by " << after[0].persistence;
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count())) {
    if (mesh.position[v] == Vec3d(6, 2, 2)) {
      EXPECT_EQ(ours.value[v], 1.0f);
    }
    if (mesh.position[v].x() > 14) {
      EXPECT_NEAR(ours.value[v], 0.7, 0.1);
    }
  }
}

// The thin plate overshoots in concave solids; the default does not, keeps every constraint, and leaves the rest
// alone, bit for bit. Every tet that it changed has a direction.
TEST_P(ConcaveMeshes, HaveNoExtremaAwayFromConstraints) {
  PITH_REQUIRE_SHARED(path, std::string("meshes/") + GetParam().file);
  const TriMesh surface = read_tri_mesh(path, GetParam().scale);
  const Box box = [&] {
    Box b;
    for (const Vec3d& p : surface.position) b.add(p);
    return b;
  }();
  const TetrahedralizeResult meshed = tetrahedralize(surface, GetParam().file, [&] {
    TetrahedralizeOptions options;
    options.interior_edge = box.diagonal() / 30;
    return options;
  }());
  const Boundary boundary = boundary_of(meshed.mesh);
  // A few places, as a user gives them: the ends of the longest side, a place on the skin half way, and the core.
  int axis = 0;
  box.extent().maxCoeff(&axis);
  const auto vertex_at = [&](double part) {
    const double at = box.low[axis] + part * box.extent()[axis];
    return *std::min_element(surface.position.begin(), surface.position.end(), [&](const Vec3d& a, const Vec3d& b) {
      return std::abs(a[axis] - at) < std::abs(b[axis] - at);
    });
  };
  const auto place = [](const Vec3d& x, double value) {
    return DepthConstraint{.value = value, .skin = false, .triangles = {}, .stroke = {x}};
  };
  const std::vector<DepthConstraint> constraints = {place(vertex_at(0), 0), place(vertex_at(1), 0.3),
                                                    place(vertex_at(0.5), 0.1), place(vertex_at(0.75), 0.8),
                                                    place(innermost(meshed.mesh, boundary), 1)};
  const DepthField paper = depth_field(meshed.mesh, boundary, 0, constraints, "depth", {.remove_extrema = false}),
                   ours = depth_field(meshed.mesh, boundary, 0, constraints, "depth");
  const auto before = extrema_in(meshed.mesh, boundary, paper, constraints),
             after = extrema_in(meshed.mesh, boundary, ours, constraints);
  double largest = 0, mean = 0;
  for (const VertexId v : all_ids<VertexId>(meshed.mesh.vertex_count())) {
    const double change = std::abs(double(ours.value[v]) - paper.value[v]);
    largest = std::max(largest, change);
    mean += change / static_cast<double>(meshed.mesh.vertex_count());
  }
  std::printf(
      "%s: %zu tets, %zu centres, extrema %zu -> %zu, worst persistence %.3f, change: largest %.3f mean %.4f\n",
      GetParam().file, meshed.mesh.tet_count(), paper.centers, before.size(), after.size(),
      before.empty() ? 0.0 : before[0].persistence, largest, mean);
  EXPECT_EQ(paper.extrema, before.size());
  EXPECT_TRUE(after.empty()) << after.size() << " left, the worst persists by " << after[0].persistence;
  const PerVertex<std::uint8_t> held = constrained_vertices(meshed.mesh, boundary, 0, constraints, "depth");
  std::size_t moved = 0;
  for (const VertexId v : all_ids<VertexId>(meshed.mesh.vertex_count())) {
    EXPECT_TRUE(!held[v] || ours.value[v] == paper.value[v]);
    moved += ours.value[v] != paper.value[v];
  }
  EXPECT_LT(static_cast<double>(moved), 0.2 * static_cast<double>(meshed.mesh.vertex_count()));
  EXPECT_EQ(moved > 0, !before.empty());
  std::size_t level = 0, changed = 0;
  for (const TetId t : all_ids<TetId>(meshed.mesh.tet_count())) {
    ASSERT_TRUE(ours.gradient[t].allFinite());
    const bool touched = std::any_of(meshed.mesh.corner[t].begin(), meshed.mesh.corner[t].end(),
                                     [&](VertexId v) { return ours.value[v] != paper.value[v]; });
    changed += ours.gradient[t] != paper.gradient[t];
    if (!touched) {
      EXPECT_EQ(ours.gradient[t], paper.gradient[t]);
    } else {
      level += ours.gradient[t].norm() * box.extent().maxCoeff() < FrameOptions().vanishing_rise;
    }
  }
  EXPECT_EQ(level, 0u) << "of " << changed;
  const ThreadLimit limit(1);
  const DepthField again = depth_field(meshed.mesh, boundary, 0, constraints, "depth");
  EXPECT_EQ(again.value, ours.value);
  EXPECT_TRUE(std::equal(again.gradient.begin(), again.gradient.end(), ours.gradient.begin()));
}

INSTANTIATE_TEST_SUITE_P(All, ConcaveMeshes,
                         ::testing::Values(Concave{"bunny_12k.off", 600}, Concave{"banana_16k_uv.obj", 500},
                                           Concave{"fertility_9k.off", 0.5}, Concave{"rocker_arm_20k.obj", 100},
                                           Concave{"torus_5k.obj", 40}),
                         [](const auto& info) {
                           std::string name = info.param.file;
                           return name.substr(0, name.find('_'));
                         });
