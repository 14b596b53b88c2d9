// Smoothed aggregation: Vaněk, Mandel, Brezina: Algebraic multigrid by smoothed aggregation for second and fourth
// order elliptic problems, Computing 56, 1996. Smoother: Chebyshev polynomials of the Jacobi-scaled matrix (Adams et
// al. 2003), which need no order of the unknowns and so run in parallel with the same bits.
#include "volume/field/multigrid.h"

#include "volume/base/parallel.h"
#include "volume/base/random.h"

#include <algorithm>
#include <cmath>

namespace pith {
namespace {

constexpr std::size_t coarsest_rows = 200; ///< solved densely
constexpr double strength = 0.25;          ///< of a coupling against the strongest of its row
constexpr int chebyshev_degree = 2;
constexpr double chebyshev_range = 4; ///< eigenvalues above largest / range are damped
constexpr int power_iterations = 12;
constexpr std::uint32_t unassigned = ~0u;

std::vector<double> diagonal_of(const SparseRows& a) {
  std::vector<double> diagonal(a.rows(), 0.0);
  for (std::size_t i = 0; i < a.rows(); ++i)
    for (std::uint32_t k = a.begin[i]; k < a.begin[i + 1]; ++k)
      if (a.column[k] == i) diagonal[i] = a.value[k];
  return diagonal;
}

/// Aggregates of strongly coupled rows (Vaněk et al., algorithm 5.1): number of the aggregate of each row.
std::vector<std::uint32_t> aggregates_of(const SparseRows& a, std::uint32_t& count) {
  const std::size_t n = a.rows();
  std::vector<double> strongest(n, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::uint32_t k = a.begin[i]; k < a.begin[i + 1]; ++k)
      if (a.column[k] != i) strongest[i] = std::max(strongest[i], std::abs(a.value[k]));
  const auto strong = [&](std::size_t i, std::uint32_t k) {
    const std::uint32_t j = a.column[k];
    return j != i && std::abs(a.value[k]) >= strength * std::min(strongest[i], strongest[j]) && a.value[k] != 0;
  };
  std::vector<std::uint32_t> aggregate(n, unassigned);
  count = 0;
  for (std::size_t i = 0; i < n; ++i) { // step 1: whole neighbourhoods that are still free
    if (aggregate[i] != unassigned) continue;
    bool free = true;
    for (std::uint32_t k = a.begin[i]; k < a.begin[i + 1] && free; ++k)
      free = !strong(i, k) || aggregate[a.column[k]] == unassigned;
    if (!free) continue;
    aggregate[i] = count;
    for (std::uint32_t k = a.begin[i]; k < a.begin[i + 1]; ++k)
      if (strong(i, k)) aggregate[a.column[k]] = count;
    ++count;
  }
  const std::vector<std::uint32_t> first = aggregate;
  for (std::size_t i = 0; i < n; ++i) { // step 2: the rest joins the neighbour it is coupled to most
    if (aggregate[i] != unassigned) continue;
    double best = 0;
    for (std::uint32_t k = a.begin[i]; k < a.begin[i + 1]; ++k)
      if (strong(i, k) && first[a.column[k]] != unassigned && std::abs(a.value[k]) > best) {
        best = std::abs(a.value[k]);
        aggregate[i] = first[a.column[k]];
      }
  }
  for (std::size_t i = 0; i < n; ++i) { // step 3: what is left forms its own
    if (aggregate[i] != unassigned) continue;
    aggregate[i] = count;
    for (std::uint32_t k = a.begin[i]; k < a.begin[i + 1]; ++k)
      if (strong(i, k) && aggregate[a.column[k]] == unassigned) aggregate[a.column[k]] = count;
    ++count;
  }
  return aggregate;
}

/// The largest eigenvalue of D⁻¹ A, nearly: power iterations of four fixed vectors, a tenth added, below Gershgorin's
/// bound.
double largest_eigenvalue_of(const SparseRows& a, const std::vector<double>& inverse_diagonal) {
  double bound = 1;
  for (std::size_t i = 0; i < a.rows(); ++i) {
    double sum = 0;
    for (std::uint32_t k = a.begin[i]; k < a.begin[i + 1]; ++k) sum += std::abs(a.value[k]);
    bound = std::max(bound, sum * inverse_diagonal[i]);
  }
  LaneVector x(a.rows()), y(a.rows());
  for (std::size_t i = 0; i < a.rows(); ++i)
    for (int k = 0; k < 4; ++k) x[i][k] = unit_double(hash_of(i, k)) - 0.5;
  double estimate = 0;
  for (int round = 0; round < power_iterations; ++round) {
    parallel_for(a.rows(), row_block, [&](std::size_t i) { y[i] = inverse_diagonal[i] * row_times(a, i, x); });
    const Lanes squared = inner_product(y, y), ratio = (squared / inner_product(x, x).max(1e-300)).sqrt();
    estimate = ratio.maxCoeff();
    const Lanes scale = 1 / squared.sqrt().max(1e-150);
    parallel_for(a.rows(), row_block, [&](std::size_t i) { x[i] = scale * y[i]; });
  }
  return std::min(bound, 1.1 * estimate);
}

/// (I − ω D⁻¹ A) times the aggregates' indicator functions, ω = 4 / (3 λ) (Vaněk et al., §3).
SparseRows smoothed_prolongation(const SparseRows& a, const std::vector<double>& inverse_diagonal, double bound,
                                 const std::vector<std::uint32_t>& aggregate, std::uint32_t count) {
  SparseRows indicator;
  indicator.columns = count;
  for (std::size_t i = 0; i < a.rows(); ++i) {
    indicator.column.push_back(aggregate[i]);
    indicator.value.push_back(1);
    indicator.begin.push_back(static_cast<std::uint32_t>(i + 1));
  }
  SparseRows smoother = a;
  const double omega = 4 / (3 * bound);
  parallel_for(a.rows(), row_block, [&](std::size_t i) {
    for (std::uint32_t k = a.begin[i]; k < a.begin[i + 1]; ++k)
      smoother.value[k] = (a.column[k] == i ? 1.0 : 0.0) - omega * inverse_diagonal[i] * a.value[k];
  });
  return product(smoother, indicator);
}

} // namespace

Multigrid::Multigrid(SparseRows matrix) {
  for (;;) {
    Level& level = level_.emplace_back();
    level.matrix = std::move(matrix);
    const std::size_t n = level.matrix.rows();
    for (LaneVector* work : {&level.right, &level.solution, &level.residual, &level.step})
      work->assign(n, Lanes::Zero());
    level.inverse_diagonal = diagonal_of(level.matrix);
    for (double& d : level.inverse_diagonal) d = d > 0 ? 1 / d : 1;
    level.largest_eigenvalue = largest_eigenvalue_of(level.matrix, level.inverse_diagonal);
    if (n <= coarsest_rows) break;
    std::uint32_t count = 0;
    const std::vector<std::uint32_t> aggregate = aggregates_of(level.matrix, count);
    if (count > n * 4 / 5) break; // hardly any coupling left: smoothing alone solves it
    level.prolongation =
        smoothed_prolongation(level.matrix, level.inverse_diagonal, level.largest_eigenvalue, aggregate, count);
    level.restriction = transposed(level.prolongation);
    matrix = product(level.restriction, product(level.matrix, level.prolongation));
  }
  const SparseRows& a = level_.back().matrix;
  if (a.rows() > coarsest_rows) return;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(a.rows(), a.rows());
  for (std::size_t i = 0; i < a.rows(); ++i) {
    for (std::uint32_t k = a.begin[i]; k < a.begin[i + 1]; ++k) dense(i, a.column[k]) = a.value[k];
    dense(i, i) *= 1 + 1e-10; // a part without constraints would be singular
  }
  coarsest_ = TiledCholesky(std::move(dense));
}

void Multigrid::smooth(Level& level, const LaneVector& r, LaneVector& z, bool from_zero) {
  const double high = level.largest_eigenvalue, low = high / chebyshev_range;
  const double center = 0.5 * (high + low), half = 0.5 * (high - low), sigma = center / half;
  double rho = 1 / sigma;
  for (int degree = 0; degree < chebyshev_degree; ++degree) {
    const double next = degree == 0 ? rho : 1 / (2 * sigma - rho);
    const double keep = degree == 0 ? 0 : next * rho, gain = degree == 0 ? 1 / center : 2 * next / half;
    const bool zero = from_zero && degree == 0;
    parallel_for(r.size(), row_block, [&](std::size_t i) {
      Lanes residual = r[i];
      if (!zero) residual -= row_times(level.matrix, i, z);
      level.step[i] = keep * level.step[i] + gain * level.inverse_diagonal[i] * residual;
    });
    parallel_for(r.size(), row_block, [&](std::size_t i) {
      if (zero)
        z[i] = level.step[i];
      else
        z[i] += level.step[i];
    });
    rho = next;
  }
}

void Multigrid::cycle(std::size_t at, const LaneVector& r, LaneVector& z) {
  Level& level = level_[at];
  const std::size_t n = r.size();
  if (at + 1 == level_.size()) {
    if (n > coarsest_rows) return smooth(level, r, z, true);
    Eigen::MatrixXd b(n, 4);
    for (std::size_t i = 0; i < n; ++i) b.row(i) = r[i].matrix().transpose();
    b = coarsest_.solve(b);
    for (std::size_t i = 0; i < n; ++i) z[i] = b.row(i).transpose().array();
    return;
  }
  smooth(level, r, z, true);
  parallel_for(n, row_block, [&](std::size_t i) { level.residual[i] = r[i] - row_times(level.matrix, i, z); });
  Level& coarse = level_[at + 1];
  multiply(level.restriction, level.residual, coarse.right);
  cycle(at + 1, coarse.right, coarse.solution);
  if (at + 2 < level_.size()) { // W: once more, with what is left
    LaneVector first = coarse.solution;
    parallel_for(first.size(), row_block,
                 [&](std::size_t i) { coarse.right[i] -= row_times(coarse.matrix, i, first); });
    cycle(at + 1, coarse.right, coarse.solution);
    parallel_for(first.size(), row_block, [&](std::size_t i) { coarse.solution[i] += first[i]; });
  }
  parallel_for(n, row_block, [&](std::size_t i) { z[i] += row_times(level.prolongation, i, coarse.solution); });
  smooth(level, r, z, false);
}

void Multigrid::apply(const LaneVector& r, LaneVector& z) { cycle(0, r, z); }

} // namespace pith
