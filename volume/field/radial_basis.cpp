// Radial basis functions with a linear polynomial: Turk, O'Brien: Shape transformation using variational implicit
// functions, SIGGRAPH 1999; kernels and their definiteness: Wendland: Scattered data approximation, 2005, §8.3.
//
// Departure: the symmetric indefinite system [K P; Pᵀ 0] is not factored as it stands. With Q from P = Q [R; 0], the
// weights live in the span of Q's last columns, where ±K is positive definite, so that a Cholesky factorisation does.
#include "volume/field/radial_basis.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/field/projected_system.h"
#include "volume/field/radial_basis_fast.h"
#include "volume/field/radial_kernels.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace pith {
namespace {

/// Where the dense method, O(n³), has become slower than the fast one.
constexpr std::size_t fast_from = 4000;

struct Data {
  std::vector<Vec3d> point; ///< scaled
  std::vector<double> value;
  double range = 0;
};

std::string text_of(const Vec3d& p) {
  std::ostringstream text;
  text << "(" << p.x() << ", " << p.y() << ", " << p.z() << ")";
  return text.str();
}

/// Later points within the radius of an earlier survivor are dropped; its value becomes the average.
Data merged(const std::vector<Vec3d>& point, std::span<const Vec3d> original, std::span<const double> value,
            const RadialBasisOptions& options) {
  Data result;
  const auto [low, high] = std::minmax_element(value.begin(), value.end());
  result.range = *high - *low;
  const double radius = options.merge, reach = radius + 1e-15, allowed = result.range * std::max(1e-9, 1e3 * radius);

  // Sorted along a direction that no face or row of points is likely to stand across.
  const Vec3d direction = Vec3d(0.5377, 0.6912, 0.4829).normalized();
  std::vector<double> along(point.size());
  for (std::size_t i = 0; i < point.size(); ++i) along[i] = direction.dot(point[i]);
  std::vector<std::uint32_t> order(point.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return along[a] != along[b] ? along[a] < along[b] : a < b; });
  std::vector<std::uint32_t> rank(point.size());
  for (std::uint32_t r = 0; r < order.size(); ++r) rank[order[r]] = r;

  std::vector<std::uint32_t> survivor(point.size());
  std::vector<double> sum(point.size(), 0.0);
  std::vector<int> members(point.size(), 0);
  for (std::uint32_t i = 0; i < point.size(); ++i) {
    std::uint32_t first = i; // the lowest-numbered survivor within the radius, else i itself
    const auto consider = [&](std::uint32_t j) {
      if (j < first && survivor[j] == j && (point[i] - point[j]).squaredNorm() <= radius * radius) first = j;
    };
    for (std::uint32_t r = rank[i]; r-- > 0 && along[i] - along[order[r]] <= reach;) consider(order[r]);
    for (std::uint32_t r = rank[i] + 1; r < order.size() && along[order[r]] - along[i] <= reach; ++r)
      consider(order[r]);
    survivor[i] = first;
    if (first != i && options.smoothing <= 0 && std::abs(value[i] - value[first]) > allowed)
      throw InvalidInput("radial basis",
                         "two values, " + std::to_string(value[first]) + " and " + std::to_string(value[i]) +
                             ", are given at one place, " + text_of(original[i]),
                         "remove one of them");
    sum[first] += value[i];
    ++members[first];
  }
  for (std::uint32_t i = 0; i < point.size(); ++i)
    if (members[i] > 0) {
      result.point.push_back(point[i]);
      result.value.push_back(sum[i] / members[i]);
    }
  return result;
}

/// Solve, then refine once with the residual of the original system: the kernel matrices are badly conditioned.
/// Weights as evaluation takes them, with the kernel's own sign.
RadialSolution dense_solution(const Centers& centers, const RadialBasisOptions& options, std::span<const Vec3d> point,
                              const Eigen::MatrixXd& p, const Eigen::VectorXd& target) {
  const Eigen::Index n = p.rows();
  const double sign = definite_sign(options.kernel);
  const ProjectedSystem system(options.kernel, point, p, options.smoothing);
  const auto kernel_times = [&](const Eigen::VectorXd& x) {
    std::vector<double> weight(padded(n), 0.0);
    std::copy(x.begin(), x.end(), weight.begin());
    Eigen::VectorXd product(n);
    with_kernel(options.kernel, [&]<Kernel kernel>() {
      parallel_for(n, 64, [&](std::size_t i) {
        Lane sum = Lane::Zero();
        add_kernels<kernel>(centers, weight.data(), 0, weight.size(), point[i], sum);
        product[i] = sign * sum_of(sum) + options.smoothing * x[i];
      });
    });
    return product;
  };
  RadialSolution solution{.weight = Eigen::VectorXd::Zero(n), .coefficient = Eigen::VectorXd::Zero(p.cols())};
  Eigen::VectorXd residual = target;
  for (int round = 0; round < 2; ++round) {
    const Eigen::VectorXd step = system.weights(residual);
    solution.weight += step;
    solution.coefficient += system.coefficients(residual - kernel_times(step));
    residual = target - kernel_times(solution.weight) - p * solution.coefficient;
  }
  for (Eigen::Index i = 0; i < n; ++i) solution.residual = std::max(solution.residual, std::abs(residual[i]));
  solution.weight *= sign;
  return solution;
}

} // namespace

RadialBasis RadialBasis::fit(std::span<const Vec3d> centers, std::span<const double> values,
                             const RadialBasisOptions& options) {
  if (centers.empty() || centers.size() != values.size())
    throw InvalidInput("radial basis",
                       std::to_string(centers.size()) + " centres with " + std::to_string(values.size()) + " values",
                       "give at least one centre, and one value to each");
  for (std::size_t i = 0; i < centers.size(); ++i)
    if (!centers[i].allFinite() || !std::isfinite(values[i]))
      throw InvalidInput("radial basis", "centre " + std::to_string(i) + " or its value is not finite",
                         "give finite numbers");

  RadialBasis result;
  result.kernel_ = options.kernel;
  Box box;
  for (const Vec3d& c : centers) box.add(c);
  const double extent = box.extent().maxCoeff();
  result.origin_ = box.center();
  result.per_mm_ = extent > 0 ? 1 / extent : 1;
  std::vector<Vec3d> scaled(centers.size());
  for (std::size_t i = 0; i < centers.size(); ++i) scaled[i] = (centers[i] - result.origin_) * result.per_mm_;
  const Data data = merged(scaled, centers, values, options);

  const std::size_t n = data.point.size();
  result.count_ = n;
  if (options.method == RadialMethod::fast && options.kernel == Kernel::thin_plate)
    throw InvalidInput("radial basis", "there is no fast method for the 2D thin plate",
                       "use the dense method, or a kernel of 3D");
  const bool fast = options.method == RadialMethod::fast || (options.method == RadialMethod::automatic &&
                                                             n >= fast_from && options.kernel != Kernel::thin_plate);
  const Spread spread = spread_of(data.point);
  const Eigen::MatrixXd p = spread.polynomials_at(data.point);
  const Eigen::VectorXd target = Eigen::Map<const Eigen::VectorXd>(data.value.data(), static_cast<Eigen::Index>(n));
  const double worth = std::max(data.range, 1e-6 * target.cwiseAbs().maxCoeff());

  RadialSolution solution;
  if (fast) {
    const auto sum = std::make_shared<KernelSum>(options.kernel, data.point);
    solution =
        fast_solution(*sum, options.kernel, data.point, p, target, options.smoothing, options.accuracy * worth);
    sum->hold({solution.weight.data(), n});
    result.fast_ = sum;
  } else {
    for (auto* array : {&result.x_, &result.y_, &result.z_, &result.weight_}) array->assign(padded(n), 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      result.x_[i] = data.point[i].x();
      result.y_[i] = data.point[i].y();
      result.z_[i] = data.point[i].z();
    }
    solution = dense_solution({result.x_.data(), result.y_.data(), result.z_.data()}, options, data.point, p, target);
    std::copy(solution.weight.begin(), solution.weight.end(), result.weight_.begin());
  }
  if (!(solution.residual <= 1e-6 * worth))
    throw SolverFailure("the radial basis system of " + std::to_string(n) +
                            " centres is singular; thin the centres or allow smoothing",
                        solution.residual);
  result.residual_ = solution.residual;
  for (Eigen::Index k = 1; k < p.cols(); ++k) result.linear_ += solution.coefficient[k] * spread.axis.col(k - 1);
  result.constant_ = solution.coefficient[0] - result.linear_.dot(spread.mean);
  return result;
}

double RadialBasis::value(const Vec3d& x) const {
  const Vec3d p = (x - origin_) * per_mm_;
  const double linear = ((linear_.x() * p.x() + linear_.y() * p.y()) + linear_.z() * p.z()) + constant_;
  if (fast_) return fast_->value(p) + linear;
  Lane sum = Lane::Zero();
  with_kernel(kernel_, [&]<Kernel kernel>() {
    add_kernels<kernel>({x_.data(), y_.data(), z_.data()}, weight_.data(), 0, weight_.size(), p, sum);
  });
  return sum_of(sum) + linear;
}

Vec3d RadialBasis::gradient(const Vec3d& x) const {
  const Vec3d p = (x - origin_) * per_mm_;
  if (fast_) return (fast_->gradient(p) + linear_) * per_mm_;
  LaneGradient sum;
  with_kernel(kernel_, [&]<Kernel kernel>() {
    add_gradients<kernel>({x_.data(), y_.data(), z_.data()}, weight_.data(), 0, weight_.size(), p, sum);
  });
  return (sum.sum() + linear_) * per_mm_;
}

void RadialBasis::values(std::span<const Vec3d> points, std::span<double> result) const {
  parallel_for(points.size(), 256, [&](std::size_t i) { result[i] = value(points[i]); });
}

void RadialBasis::gradients(std::span<const Vec3d> points, std::span<Vec3d> result) const {
  parallel_for(points.size(), 256, [&](std::size_t i) { result[i] = gradient(points[i]); });
}

} // namespace pith
