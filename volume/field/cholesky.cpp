// Right-looking Cholesky factorisation by tiles (Golub, Van Loan: Matrix computations, §4.2.6). Every tile product is
// one task with a fixed place and order, so that the rounding does not depend on the threads.
#include "volume/field/cholesky.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"

#include <Eigen/Cholesky>
#include <string>
#include <utility>
#include <vector>

namespace pith {
namespace {

constexpr Eigen::Index tile = 64;

} // namespace

TiledCholesky::TiledCholesky(Eigen::MatrixXd lower) : l_(std::move(lower)) {
  const Eigen::Index n = l_.rows(), tiles = (n + tile - 1) / tile;
  const auto begin_of = [](Eigen::Index t) { return t * tile; };
  const auto size_of = [n](Eigen::Index t) { return std::min(tile, n - t * tile); };
  for (Eigen::Index k = 0; k < tiles; ++k) {
    auto diagonal = l_.block(begin_of(k), begin_of(k), size_of(k), size_of(k));
    const Eigen::LLT<Eigen::MatrixXd> factor(diagonal);
    if (factor.info() != Eigen::Success)
      throw SolverFailure("a system of " + std::to_string(n) + " rows is not positive definite near row " +
                              std::to_string(begin_of(k)) + "; two centres may coincide",
                          factor.matrixLLT().diagonal().minCoeff());
    const Eigen::MatrixXd l_kk = factor.matrixL();
    diagonal = l_kk;

    const Eigen::Index below = tiles - k - 1;
    parallel_for(below, 1, [&](std::size_t at) {
      const Eigen::Index i = k + 1 + static_cast<Eigen::Index>(at);
      Eigen::MatrixXd panel = l_.block(begin_of(i), begin_of(k), size_of(i), size_of(k)).transpose();
      l_kk.triangularView<Eigen::Lower>().solveInPlace(panel);
      l_.block(begin_of(i), begin_of(k), size_of(i), size_of(k)) = panel.transpose();
    });

    std::vector<std::pair<Eigen::Index, Eigen::Index>> pairs;
    pairs.reserve(below * (below + 1) / 2);
    for (Eigen::Index j = k + 1; j < tiles; ++j)
      for (Eigen::Index i = j; i < tiles; ++i) pairs.emplace_back(i, j);
    parallel_for(pairs.size(), 2, [&](std::size_t at) {
      const auto [i, j] = pairs[at];
      l_.block(begin_of(i), begin_of(j), size_of(i), size_of(j)).noalias() -=
          l_.block(begin_of(i), begin_of(k), size_of(i), size_of(k)) *
          l_.block(begin_of(j), begin_of(k), size_of(j), size_of(k)).transpose();
    });
  }
}

Eigen::MatrixXd TiledCholesky::solve(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x = b;
  if (x.size() == 0) return x;
  l_.triangularView<Eigen::Lower>().solveInPlace(x);
  l_.transpose().triangularView<Eigen::Upper>().solveInPlace(x);
  return x;
}

} // namespace pith
