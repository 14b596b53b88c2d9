#include "volume/field/smooth.h"

#include "tests/support/tet_grid.h"
#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

using namespace pith;

namespace {

FieldConstraint at_corner(TetId tet, int corner, const Vec3d& value) {
  FieldConstraint constraint{.tet = tet, .barycentric = {}, .value = value};
  constraint.barycentric[corner] = 1;
  return constraint;
}

std::vector<FieldConstraint> random_constraints(const TetMesh& mesh, int count, std::uint64_t seed) {
  std::vector<FieldConstraint> constraints;
  for (int i = 0; i < count; ++i) {
    Random random(seed, i);
    FieldConstraint c;
    c.tet = TetId(random.below(static_cast<std::uint32_t>(mesh.tet_count())));
    double sum = 0;
    for (double& b : c.barycentric) sum += b = random.uniform(0.05, 1);
    for (double& b : c.barycentric) b /= sum;
    for (int k = 0; k < 3; ++k) c.value[k] = random.uniform(-1, 1);
    constraints.push_back(c);
  }
  return constraints;
}

/// The same least squares problem, written out densely.
PerVertex<Vec3d> dense_solution(const TetMesh& mesh, const std::vector<FieldConstraint>& constraints,
                                const SmoothOptions& options) {
  const auto n = static_cast<Eigen::Index>(mesh.vertex_count());
  const VertexNeighbors neighbors = vertices_around_vertices(mesh);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n + static_cast<Eigen::Index>(constraints.size()), n);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(rows.rows(), 3);
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count())) {
    double sum = 0;
    for (const VertexId w : neighbors[v]) {
      double weight = 1;
      if (!options.depth.empty())
        weight = std::exp(-std::pow((options.depth[v] - options.depth[w]) / options.layer_width, 2));
      rows(v.value, w.value) = -weight;
      sum += weight;
    }
    rows.row(v.value) /= sum;
    rows(v.value, v.value) = 1;
  }
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    const auto row = n + static_cast<Eigen::Index>(c);
    for (int k = 0; k < 4; ++k)
      rows(row, mesh.corner[constraints[c].tet][k].value) = options.constraint_weight * constraints[c].barycentric[k];
    right.row(row) = options.constraint_weight * constraints[c].value.transpose();
  }
  const Eigen::MatrixXd x = (rows.transpose() * rows).ldlt().solve(rows.transpose() * right);
  PerVertex<Vec3d> result;
  for (Eigen::Index i = 0; i < n; ++i) result.push_back(x.row(i).transpose());
  return result;
}

} // namespace

TEST(Smooth, OneConstraintMakesAConstantField) {
  const TetMesh ball = tet_ball(12, 5);
  const Vec3d value(0.3, -2, 7);
  const auto field = smooth_vectors(ball, -1, std::vector{at_corner(TetId(77), 2, value)}, {.tolerance = 1e-10});
  for (const Vec3d& v : field) EXPECT_LT((v - value).norm(), 1e-6);
}

TEST(Smooth, EqualConstraintsMakeAConstantFieldWhateverTheDepth) {
  const TetMesh ball = tet_ball(10, 5);
  std::vector<float> depth;
  for (const Vec3d& p : ball.position) depth.push_back(static_cast<float>(1 - p.norm() / 5));
  std::vector<FieldConstraint> constraints = random_constraints(ball, 9, 4);
  for (FieldConstraint& c : constraints) c.value = {1, 2, 3};
  const auto field = smooth_vectors(ball, 0, constraints, {.tolerance = 1e-10, .depth = depth, .layer_width = 0.2});
  for (const Vec3d& v : field) EXPECT_LT((v - Vec3d(1, 2, 3)).norm(), 1e-7);
}

TEST(Smooth, AgreesWithTheDenseLeastSquares) {
  TetMesh mesh = tet_grid(6, 5, 7);
  std::vector<float> depth;
  for (Vec3d& p : mesh.position) {
    Random random(5, static_cast<std::uint64_t>(&p - mesh.position.data()));
    depth.push_back(static_cast<float>(random.uniform()));
  }
  const std::vector<FieldConstraint> constraints = random_constraints(mesh, 12, 6);
  for (const bool layered : {false, true}) {
    SmoothOptions options{.tolerance = 1e-12};
    if (layered) {
      options.depth = depth;
      options.layer_width = 0.5;
    }
    const auto expected = dense_solution(mesh, constraints, options);
    const auto field = smooth_vectors(mesh, 0, constraints, options);
    const auto loose =
        smooth_vectors(mesh, 0, constraints, {.depth = options.depth, .layer_width = options.layer_width});
    for (const VertexId v : all_ids<VertexId>(mesh.vertex_count())) {
      EXPECT_LT((field[v] - expected[v]).norm(), 1e-8);
      EXPECT_LT((loose[v] - expected[v]).norm(), 1e-3); // the default tolerance
    }
  }
}

// A linear field has no Laplacian inside a regular grid; the skin's own Laplacians are settled by two given layers.
TEST(Smooth, KeepsLinearFieldsWhoseOuterLayersAreGiven) {
  const TetMesh mesh = tet_grid(8, 8, 8);
  const auto linear = [](const Vec3d& p) { return Vec3d(p.x(), p.y() - 2 * p.z(), 5 + p.x() + p.y() + p.z()); };
  std::vector<FieldConstraint> constraints;
  const VertexTets around = tets_around_vertices(mesh);
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count())) {
    const Vec3d& p = mesh.position[v];
    if (p.minCoeff() > 1 && p.maxCoeff() < 7) continue;
    const TetId tet = around[v][0];
    const auto& corner = mesh.corner[tet];
    const int k = static_cast<int>(std::find(corner.begin(), corner.end(), v) - corner.begin());
    constraints.push_back(at_corner(tet, k, linear(p)));
  }
  const auto field = smooth_vectors(mesh, 0, constraints, {.constraint_weight = 1000, .tolerance = 1e-9});
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count()))
    EXPECT_LT((field[v] - linear(mesh.position[v])).norm(), 1e-3);
}

TEST(Smooth, LeavesOtherRegionsAtZero) {
  TetMesh mesh = tet_grid(8, 4, 4);
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) mesh.region[t] = barycenter(mesh, t).x() < 4 ? 0 : 1;
  const auto field = smooth_vectors(mesh, 0, std::vector{at_corner(TetId(0), 0, {0, 0, 2})}, {.tolerance = 1e-10});
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count()))
    EXPECT_NEAR(field[v].z(), mesh.position[v].x() <= 4 ? 2 : 0, 1e-7);
}

// The number of iterations hardly grows with the mesh: multigrid at work.
TEST(Smooth, ConvergesQuicklyOnAnyMesh) {
  for (const int n : {8, 16, 24}) {
    const TetMesh ball = tet_ball(n, 5);
    SmoothReport report;
    smooth_vectors(ball, 0, random_constraints(ball, 40, 8), {}, &report);
    EXPECT_LT(report.iterations, 70) << n;
    EXPECT_LE(report.residual, 1e-6);
  }
}

TEST(Smooth, IsTheSameOnAnyNumberOfThreads) {
  const TetMesh ball = tet_ball(20, 5);
  const std::vector<FieldConstraint> constraints = random_constraints(ball, 15, 9);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return smooth_vectors(ball, 0, constraints);
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(Smooth, RefusesUnusableInput) {
  TetMesh mesh = tet_grid(2, 2, 2);
  mesh.region[TetId(5)] = 1;
  const std::vector<FieldConstraint> good = {at_corner(TetId(0), 0, {1, 0, 0})};
  EXPECT_THROW(smooth_vectors(mesh, 0, {}), InvalidInput);
  EXPECT_THROW(smooth_vectors(mesh, 1, good), InvalidInput);
  EXPECT_THROW(smooth_vectors(mesh, 0, std::vector{at_corner(TetId(4000), 0, {1, 0, 0})}), InvalidInput);
  EXPECT_THROW(smooth_vectors(mesh, 0, std::vector{at_corner(TetId(0), 0, {NAN, 0, 0})}), InvalidInput);
  EXPECT_THROW(smooth_vectors(mesh, 0, std::vector{FieldConstraint{.tet = TetId(0)}}), InvalidInput);
  EXPECT_THROW(smooth_vectors(mesh, 0, good, {.layer_width = 0}), InvalidInput);
  const std::vector<float> short_depth(3, 0.5f);
  EXPECT_THROW(smooth_vectors(mesh, 0, good, {.depth = short_depth}), InvalidInput);
  EXPECT_THROW(smooth_vectors(tet_ball(12), 0, random_constraints(tet_ball(12), 5, 1), {.max_iterations = 1}),
               SolverFailure);
}
