// Large radial basis systems by a preconditioned Krylov method: Beatson, Light, Billings 2000 (the preconditioner),
// with products by the fast multipole method. The iteration is the generalised conjugate residual method (Eisenstat,
// Elman, Schultz 1983), which takes a preconditioner that is not symmetric and knows its residual at every step.
//
// The equation is Π(±K + λ)w = Πf among weights w = Πw, where Π takes away linear functions of the place; what is
// left of f then is linear, and gives the polynomial.
#include "volume/field/radial_basis_fast.h"

#include "volume/field/schwarz.h"

#include <Eigen/QR>
#include <algorithm>

namespace pith {
namespace {

constexpr int most_iterations = 120;

struct Direction {
  Eigen::VectorXd step, image; ///< image = Π(±K + λ) step, of length 1
};

} // namespace

RadialSolution fast_solution(const KernelSum& sum, Kernel kernel, std::span<const Vec3d> point,
                             const Eigen::MatrixXd& p, const Eigen::VectorXd& value, double smoothing,
                             double tolerance) {
  const Eigen::Index n = p.rows();
  const double sign = definite_sign(kernel);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(p);
  const Eigen::MatrixXd orthonormal = qr.householderQ() * Eigen::MatrixXd::Identity(n, p.cols());
  const auto project = [&](Eigen::VectorXd& x) { x -= orthonormal * (orthonormal.transpose() * x); };
  const auto times = [&](const Eigen::VectorXd& x) {
    Eigen::VectorXd product(n);
    sum.at_centers({x.data(), std::size_t(n)}, {product.data(), std::size_t(n)});
    return Eigen::VectorXd(sign * product + smoothing * x);
  };
  const std::size_t coarse =
      std::clamp<std::size_t>(point.size() / 8, 500, std::clamp<std::size_t>(point.size() / 40, 2500, 8000));
  const Schwarz schwarz(sum, kernel, point, orthonormal, {.coarse = coarse, .smoothing = smoothing});

  RadialSolution solution;
  solution.weight = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd residual = value;
  project(residual);
  std::vector<Direction> past;
  const auto largest = [](const Eigen::VectorXd& x) { return x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0.0; };
  for (; solution.iterations < most_iterations && largest(residual) > tolerance; ++solution.iterations) {
    Direction next{.step = schwarz.apply(residual), .image = {}};
    project(next.step);
    next.image = times(next.step);
    project(next.image);
    for (const Direction& d : past) {
      const double along = d.image.dot(next.image);
      next.image -= along * d.image;
      next.step -= along * d.step;
    }
    const double length = next.image.norm();
    if (!(length > 0)) break;
    next.image /= length;
    next.step /= length;
    const double gain = next.image.dot(residual);
    solution.weight += gain * next.step;
    residual -= gain * next.image;
    past.push_back(std::move(next));
  }

  const Eigen::VectorXd rest = value - times(solution.weight);
  const Eigen::VectorXd turned = orthonormal.transpose() * rest;
  solution.coefficient = (orthonormal.transpose() * p).lu().solve(turned);
  solution.residual = largest(rest - p * solution.coefficient);
  solution.weight *= sign;
  return solution;
}

} // namespace pith
