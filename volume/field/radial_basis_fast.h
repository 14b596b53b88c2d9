#pragma once
// Radial basis functions through many centres (private to the field module).
#include "volume/field/kernel_sum.h"
#include "volume/field/projected_system.h"

namespace pith {

/// Kernel weights and polynomial coefficients of the system [±K + λ, P; Pᵀ, 0].
struct RadialSolution {
  Eigen::VectorXd weight, coefficient;
  int iterations = 0;
  double residual = 0; ///< largest over the centres
};

/// Solves until the largest residual is at most `tolerance`, or stops getting smaller. O(n log n).
RadialSolution fast_solution(const KernelSum& sum, Kernel kernel, std::span<const Vec3d> point,
                             const Eigen::MatrixXd& p, const Eigen::VectorXd& value, double smoothing,
                             double tolerance);

} // namespace pith
