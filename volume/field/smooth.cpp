// Laplacian smoothing with soft constraints: Takayama 2008, §5.2.2, Eqs. 1–2 (after Fu et al. 2007).
//
// The normal equations A x = c² Bᵀ v, A = Lᵀ L + c² Bᵀ B, are solved by conjugate gradients for the three components
// at once. With sᵢⱼ the symmetric weights, D their row sums and M = D − S, the Laplacian of Eq. 1 is L = D⁻¹ M, so
// that Lᵀ L = M D⁻² M. Its condition grows with the fourth power of the resolution; the preconditioner V D² V, with V
// one multigrid cycle for M + c D^½ Bᵀ B D^½, near the square root of A, keeps the number of iterations nearly
// constant.
#include "volume/field/smooth.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/field/multigrid.h"

#include <algorithm>
#include <cmath>

namespace pith {
namespace {

/// The part of the mesh that takes part, with its own vertex numbers.
struct Part {
  std::vector<VertexId> vertex;    ///< of the mesh, ascending
  PerVertex<std::uint32_t> number; ///< of the part; of vertices that take part only
  VertexNeighbors neighbors;
};

Part part_of(const TetMesh& mesh, std::int32_t region) {
  constexpr std::uint32_t absent = ~0u;
  Part part;
  part.number.assign(mesh.vertex_count(), absent);
  TetMesh kept;
  kept.corner.reserve(mesh.tet_count());
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    if (region < 0 || mesh.region[t] == region) {
      kept.corner.push_back(mesh.corner[t]);
      for (const VertexId v : mesh.corner[t]) part.number[v] = 0;
    }
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count()))
    if (part.number[v] != absent) {
      part.number[v] = static_cast<std::uint32_t>(part.vertex.size());
      part.vertex.push_back(v);
    }
  for (auto& corner : kept.corner)
    for (VertexId& v : corner) v = VertexId(part.number[v]);
  kept.position.resize(part.vertex.size());
  part.neighbors = vertices_around_vertices(kept);
  return part;
}

/// M = D − S, the diagonal first in every row, and D.
struct Laplacian {
  SparseRows matrix;
  std::vector<double> degree;
};

/// Eq. 1, with the weights of the paper's last formula of §5.2.2 when depths are given.
Laplacian laplacian_of(const Part& part, const SmoothOptions& options) {
  const std::size_t n = part.vertex.size();
  Laplacian l;
  l.matrix.columns = n;
  l.matrix.begin.resize(n + 1);
  for (std::size_t i = 0; i <= n; ++i) l.matrix.begin[i] = part.neighbors.begin[i] + static_cast<std::uint32_t>(i);
  l.matrix.column.resize(l.matrix.begin[n]);
  l.matrix.value.resize(l.matrix.begin[n]);
  l.degree.resize(n);
  parallel_for(n, row_block, [&](std::size_t i) {
    std::uint32_t at = l.matrix.begin[i];
    const std::uint32_t diagonal = at++;
    double degree = 0;
    for (const VertexId j : part.neighbors[VertexId(i)]) {
      double weight = 1;
      if (!options.depth.empty()) {
        const double difference = options.depth[part.vertex[i]] - options.depth[part.vertex[j]];
        const double layers = difference / options.layer_width;
        weight = std::exp(-std::min(layers * layers, 12.0)); // below 6·10⁻⁶ a weight only hurts the solver
      }
      degree += weight;
      l.matrix.column[at] = j;
      l.matrix.value[at++] = -weight;
    }
    l.matrix.column[diagonal] = static_cast<std::uint32_t>(i);
    l.matrix.value[diagonal] = degree;
    l.degree[i] = degree > 0 ? degree : 1;
  });
  return l;
}

/// The system A x = b of the normal equations.
class NormalEquations {
public:
  NormalEquations(const Part& part, const Laplacian& laplacian, const TetMesh& mesh,
                  std::span<const FieldConstraint> constraints, double weight)
      : laplacian_(laplacian), squared_weight_(weight * weight), half_(part.vertex.size(), Lanes::Zero()) {
    for (const FieldConstraint& constraint : constraints) {
      Row row{.vertex = {}, .weight = constraint.barycentric, .value = Lanes::Zero()};
      for (int k = 0; k < 4; ++k) row.vertex[k] = part.number[mesh.corner[constraint.tet][k]];
      row.value.head<3>() = constraint.value.array();
      rows_.push_back(row);
    }
  }

  LaneVector right_side() const {
    LaneVector b(half_.size(), Lanes::Zero());
    for (const Row& row : rows_)
      for (int k = 0; k < 4; ++k) b[row.vertex[k]] += squared_weight_ * row.weight[k] * row.value;
    return b;
  }

  void apply(const LaneVector& x, LaneVector& result) {
    parallel_for(x.size(), row_block, [&](std::size_t i) {
      const double scale = 1 / laplacian_.degree[i];
      half_[i] = scale * scale * row_times(laplacian_.matrix, i, x);
    });
    multiply(laplacian_.matrix, half_, result);
    for (const Row& row : rows_) {
      Lanes at = Lanes::Zero();
      for (int k = 0; k < 4; ++k) at += row.weight[k] * x[row.vertex[k]];
      for (int k = 0; k < 4; ++k) result[row.vertex[k]] += squared_weight_ * row.weight[k] * at;
    }
  }

  /// M + c D^½ Bᵀ B D^½: near a square root of the scaled system. A tet's corners are neighbours: no entry is new.
  SparseRows root() const {
    SparseRows root = laplacian_.matrix;
    for (const Row& row : rows_)
      for (int k = 0; k < 4; ++k)
        for (int l = 0; l < 4; ++l) {
          std::uint32_t at = root.begin[row.vertex[k]];
          while (root.column[at] != row.vertex[l]) ++at;
          const double degrees = laplacian_.degree[row.vertex[k]] * laplacian_.degree[row.vertex[l]];
          root.value[at] += std::sqrt(squared_weight_ * degrees) * row.weight[k] * row.weight[l];
        }
    return root;
  }

private:
  struct Row {
    std::array<std::uint32_t, 4> vertex;
    std::array<double, 4> weight;
    Lanes value;
  };
  const Laplacian& laplacian_;
  double squared_weight_;
  std::vector<Row> rows_;
  LaneVector half_;
};

/// V D² V.
class Preconditioner {
public:
  Preconditioner(SparseRows root, const std::vector<double>& degree)
      : multigrid_(std::move(root)), degree_(degree), half_(degree.size(), Lanes::Zero()) {}

  void apply(const LaneVector& r, LaneVector& z) {
    multigrid_.apply(r, half_);
    parallel_for(half_.size(), row_block, [&](std::size_t i) { half_[i] *= degree_[i] * degree_[i]; });
    multigrid_.apply(half_, z);
  }

private:
  Multigrid multigrid_;
  const std::vector<double>& degree_;
  LaneVector half_;
};

Lanes quotient(const Lanes& a, const Lanes& b) {
  Lanes q;
  for (int k = 0; k < 4; ++k) q[k] = b[k] > 0 ? a[k] / b[k] : 0.0;
  return q;
}

/// Preconditioned conjugate gradients, one step length per component; a component that has converged stands still.
LaneVector solution_of(NormalEquations& system, Preconditioner& preconditioner, const SmoothOptions& options,
                       SmoothReport* report) {
  LaneVector r = system.right_side();
  const std::size_t n = r.size();
  LaneVector x(n, Lanes::Zero()), z(n), p(n), q(n);
  preconditioner.apply(r, z);
  p = z;
  Lanes rz = inner_product(r, z);
  const Lanes first = rz;
  const double goal = options.tolerance * options.tolerance;
  int iteration = 0;
  for (;; ++iteration) {
    const Lanes active = (rz > goal * first).select(Lanes::Ones(), Lanes::Zero());
    if (!(active > 0).any()) break;
    if (iteration >= options.max_iterations || !rz.allFinite())
      throw SolverFailure("smoothing " + std::to_string(n) + " vertices did not converge in " +
                              std::to_string(iteration) + " iterations; loosen the tolerance",
                          std::sqrt(quotient(rz, first).maxCoeff()));
    system.apply(p, q);
    const Lanes alpha = active * quotient(rz, inner_product(p, q));
    parallel_for(n, row_block, [&](std::size_t i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * q[i];
    });
    preconditioner.apply(r, z);
    const Lanes next = inner_product(r, z);
    const Lanes beta = quotient(next, rz);
    parallel_for(n, row_block, [&](std::size_t i) { p[i] = z[i] + beta * p[i]; });
    rz = next;
  }
  if (report) *report = {.iterations = iteration, .residual = std::sqrt(quotient(rz, first).maxCoeff())};
  return x;
}

void check(const TetMesh& mesh, std::int32_t region, std::span<const FieldConstraint> constraints,
           const SmoothOptions& options) {
  if (constraints.empty())
    throw InvalidInput("smoothing", "there is no constraint", "prescribe a value at one place at least");
  if (!options.depth.empty() && options.depth.size() != mesh.vertex_count())
    throw InvalidInput("smoothing",
                       std::to_string(options.depth.size()) + " depths are given for " +
                           std::to_string(mesh.vertex_count()) + " vertices",
                       "give one to each vertex, or none");
  if (!(options.constraint_weight > 0) || !(options.layer_width > 0) || !(options.tolerance > 0))
    throw InvalidInput("smoothing", "a weight, width or tolerance is not positive", "give positive numbers");
  for (const FieldConstraint& c : constraints) {
    if (c.tet.value >= mesh.tet_count() || (region >= 0 && mesh.region[c.tet] != region))
      throw InvalidInput("smoothing", "a constraint lies in no tet of region " + std::to_string(region),
                         "locate constraints in this region");
    double sum = 0;
    for (const double b : c.barycentric) sum += b;
    if (!c.value.allFinite() || !(std::abs(sum - 1) < 1e-6))
      throw InvalidInput("smoothing", "a constraint's value or barycentric coordinates are unusable",
                         "give finite values and coordinates that sum to 1");
  }
}

} // namespace

PerVertex<Vec3d> smooth_vectors(const TetMesh& mesh, std::int32_t region,
                                std::span<const FieldConstraint> constraints, const SmoothOptions& options,
                                SmoothReport* report) {
  check(mesh, region, constraints, options);
  const Part part = part_of(mesh, region);
  const Laplacian laplacian = laplacian_of(part, options);
  NormalEquations system(part, laplacian, mesh, constraints, options.constraint_weight);
  Preconditioner preconditioner(system.root(), laplacian.degree);
  const LaneVector x = solution_of(system, preconditioner, options, report);

  PerVertex<Vec3d> result(mesh.vertex_count(), Vec3d::Zero());
  for (std::size_t i = 0; i < part.vertex.size(); ++i) result[part.vertex[i]] = x[i].head<3>().matrix();
  return result;
}

} // namespace pith
