#pragma once
// The dense system of radial basis functions, made definite by projection (private to the field module).
#include "volume/field/cholesky.h"
#include "volume/field/radial_kernels.h"

#include <span>

namespace pith {

/// Directions in which points spread (orthonormal columns, 0 to 3), and their mean.
struct Spread {
  Vec3d mean = Vec3d::Zero();
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> axis;

  Eigen::Index polynomials() const { return 1 + axis.cols(); }
  /// One row per point: 1, then its coordinates along the axes.
  Eigen::MatrixXd polynomials_at(std::span<const Vec3d> point) const;
};

/// Directions that hold less than `flat` of the largest variance count as none.
Spread spread_of(std::span<const Vec3d> point, double flat = 1e-14);

/// [±K + λ, P; Pᵀ, 0]: with Q from P = Q [R; 0] (Q = I − V T Vᵀ), the weights live in the span of Q's last columns,
/// where ±K is positive definite, so that a Cholesky factorisation does.
struct ProjectedSystem {
  Eigen::MatrixXd v, t, r;
  TiledCholesky factor;

  /// Errors: SolverFailure when the projected matrix is not positive definite. O(n³/3) on all threads.
  ProjectedSystem(Kernel kernel, std::span<const Vec3d> point, const Eigen::MatrixXd& p, double smoothing);

  /// The weights of one solution per column of right sides; they meet Pᵀ w = 0.
  Eigen::MatrixXd weights(const Eigen::MatrixXd& right) const;
  /// The polynomial's coefficients, from what the right side leaves after the kernels' part.
  Eigen::VectorXd coefficients(const Eigen::VectorXd& rest) const;
};

} // namespace pith
