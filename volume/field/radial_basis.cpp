// Radial basis functions with a linear polynomial: Turk, O'Brien: Shape transformation using variational implicit
// functions, SIGGRAPH 1999; kernels and their definiteness: Wendland: Scattered data approximation, 2005, §8.3.
//
// Departure: the symmetric indefinite system [K P; Pᵀ 0] is not factored as it stands. With Q from P = Q [R; 0], the
// weights live in the span of Q's last columns, where ±K is positive definite, so that a Cholesky factorisation does.
#include "volume/field/radial_basis.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/field/cholesky.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace pith {
namespace {

constexpr std::size_t lanes = 8;
using Lane = Eigen::Array<double, lanes, 1>;

std::size_t padded(std::size_t count) { return (count + lanes - 1) / lanes * lanes; }

Lane load(const std::vector<double>& array, std::size_t at) { return Eigen::Map<const Lane>(array.data() + at); }

/// The lanes' sum in one fixed order.
double sum_of(const Lane& l) { return ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7])); }

/// r² log r = r² log(r²) / 2, continuous at 0.
constexpr double smallest_square = 1e-300;

template <Kernel kernel>
Lane kernel_of(const Lane& square) {
  if constexpr (kernel == Kernel::biharmonic) return square.sqrt();
  if constexpr (kernel == Kernel::triharmonic) return square * square.sqrt();
  if constexpr (kernel == Kernel::thin_plate) return 0.5 * square * square.max(smallest_square).log();
}

/// k'(r) / r: times (x − c) it is the kernel's gradient.
template <Kernel kernel>
Lane slope_of(const Lane& square) {
  if constexpr (kernel == Kernel::biharmonic) return (square > 0).select(1 / square.max(smallest_square).sqrt(), 0.0);
  if constexpr (kernel == Kernel::triharmonic) return 3 * square.sqrt();
  if constexpr (kernel == Kernel::thin_plate) return square.max(smallest_square).log() + 1;
}

/// Calls body.operator()<kernel>().
template <class Body>
auto with_kernel(Kernel kernel, const Body& body) {
  switch (kernel) {
  case Kernel::biharmonic:
    return body.template operator()<Kernel::biharmonic>();
  case Kernel::thin_plate:
    return body.template operator()<Kernel::thin_plate>();
  case Kernel::triharmonic:
    break;
  }
  return body.template operator()<Kernel::triharmonic>();
}

struct Centers {
  const std::vector<double>&x, &y, &z;

  Lane squared_distance(std::size_t at, const Vec3d& p) const {
    const Lane dx = p.x() - load(x, at), dy = p.y() - load(y, at), dz = p.z() - load(z, at);
    return dx * dx + dy * dy + dz * dz;
  }
};

/// Σ wᵢ k(|p − cᵢ|), p scaled.
template <Kernel kernel>
double kernel_sum(const Centers& centers, const std::vector<double>& weight, const Vec3d& p) {
  Lane sum = Lane::Zero();
  for (std::size_t i = 0; i < weight.size(); i += lanes)
    sum += load(weight, i) * kernel_of<kernel>(centers.squared_distance(i, p));
  return sum_of(sum);
}

template <Kernel kernel>
Vec3d kernel_gradient(const Centers& centers, const std::vector<double>& weight, const Vec3d& p) {
  Lane gx = Lane::Zero(), gy = Lane::Zero(), gz = Lane::Zero();
  for (std::size_t i = 0; i < weight.size(); i += lanes) {
    const Lane dx = p.x() - load(centers.x, i), dy = p.y() - load(centers.y, i), dz = p.z() - load(centers.z, i);
    const Lane slope = load(weight, i) * slope_of<kernel>(dx * dx + dy * dy + dz * dz);
    gx += slope * dx;
    gy += slope * dy;
    gz += slope * dz;
  }
  return {sum_of(gx), sum_of(gy), sum_of(gz)};
}

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
  const double radius = options.merge, allowed = result.range * std::max(1e-9, 1e3 * radius);

  std::vector<std::uint32_t> order(point.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return point[a].x() != point[b].x() ? point[a].x() < point[b].x() : a < b;
  });
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
    for (std::uint32_t r = rank[i]; r-- > 0 && point[i].x() - point[order[r]].x() <= radius;) consider(order[r]);
    for (std::uint32_t r = rank[i] + 1; r < order.size() && point[order[r]].x() - point[i].x() <= radius; ++r)
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

/// Directions in which the centres spread (orthonormal columns, 0 to 3), and their mean.
struct Spread {
  Vec3d mean = Vec3d::Zero();
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> axis;
};

Spread spread_of(const std::vector<Vec3d>& point) {
  Spread spread;
  for (const Vec3d& p : point) spread.mean += p;
  spread.mean /= static_cast<double>(point.size());
  Mat3d covariance = Mat3d::Zero();
  for (const Vec3d& p : point) covariance += (p - spread.mean) * (p - spread.mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3d> eigen(covariance);
  const double largest = eigen.eigenvalues()[2];
  int used = 0;
  for (int k = 0; k < 3; ++k)
    if (eigen.eigenvalues()[k] > 1e-14 * largest && largest > 0) ++used;
  spread.axis = eigen.eigenvectors().rightCols(used);
  return spread;
}

/// The projected system: Q = I − V T Vᵀ, and the Cholesky factor of the definite block of Qᵀ (±K + λ) Q.
struct Projected {
  Eigen::MatrixXd v, t, r;
  TiledCholesky factor;

  Eigen::VectorXd apply(const Eigen::VectorXd& x) const { return x - v * (t * (v.transpose() * x)); }
  Eigen::VectorXd apply_transposed(const Eigen::VectorXd& x) const {
    return x - v * (t.transpose() * (v.transpose() * x));
  }
};

template <Kernel kernel>
Projected projected_system(const Centers& centers, const std::vector<Vec3d>& point, const Eigen::MatrixXd& p,
                           double sign, double smoothing) {
  const Eigen::Index n = p.rows(), q = p.cols();
  Projected result;
  // Householder QR of P, its reflectors gathered into the compact form (Schreiber, Van Loan 1989).
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(p);
  result.r = qr.matrixQR().topRows(q).triangularView<Eigen::Upper>();
  result.v = Eigen::MatrixXd::Zero(n, q);
  result.t = Eigen::MatrixXd::Zero(q, q);
  for (Eigen::Index k = 0; k < q; ++k) {
    result.v(k, k) = 1;
    result.v.col(k).tail(n - k - 1) = qr.matrixQR().col(k).tail(n - k - 1);
    const double tau = qr.hCoeffs()[k];
    result.t(k, k) = tau;
    if (k > 0) {
      const Eigen::VectorXd inner = result.v.leftCols(k).transpose() * result.v.col(k);
      result.t.col(k).head(k) = -tau * (result.t.topLeftCorner(k, k) * inner);
    }
  }

  // ±K + λ by columns, and Y = (±K + λ) V. Full columns: both need them.
  const Eigen::Index rows = static_cast<Eigen::Index>(padded(n));
  Eigen::MatrixXd k(rows, n), y(q, n), v_rows = Eigen::MatrixXd::Zero(rows, q);
  v_rows.topRows(n) = result.v;
  parallel_for(n, 16, [&](std::size_t j) {
    for (Eigen::Index i = 0; i < rows; i += lanes)
      k.col(j).template segment<lanes>(i) =
          (sign * kernel_of<kernel>(centers.squared_distance(i, point[j]))).matrix();
    k(j, j) += smoothing;
    for (Eigen::Index c = 0; c < q; ++c) {
      Lane sum = Lane::Zero();
      for (Eigen::Index i = 0; i < rows; i += lanes)
        sum += k.col(j).template segment<lanes>(i).array() * v_rows.col(c).template segment<lanes>(i).array();
      y(c, j) = sum_of(sum);
    }
  });

  // Qᵀ (±K + λ) Q = (±K + λ) − W Vᵀ − V Wᵀ with W = Y T − V Tᵀ (Vᵀ Y) T / 2.
  const Eigen::MatrixXd yt = y.transpose() * result.t;
  const Eigen::MatrixXd w = yt - 0.5 * result.v * (result.t.transpose() * (result.v.transpose() * yt));
  const Eigen::Index m = n - q;
  Eigen::MatrixXd definite(m, m);
  parallel_for(m, 16, [&](std::size_t j) {
    const Eigen::Index length = m - static_cast<Eigen::Index>(j);
    auto column = definite.col(j).tail(length);
    column = k.col(q + j).segment(q + j, length);
    for (Eigen::Index c = 0; c < q; ++c)
      column -= w.col(c).tail(length) * result.v(q + j, c) + result.v.col(c).tail(length) * w(q + j, c);
  });
  result.factor = TiledCholesky(std::move(definite));
  return result;
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
  for (auto* array : {&result.x_, &result.y_, &result.z_, &result.weight_}) array->assign(padded(n), 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    result.x_[i] = data.point[i].x();
    result.y_[i] = data.point[i].y();
    result.z_[i] = data.point[i].z();
  }
  const Centers soa{result.x_, result.y_, result.z_};
  // r is conditionally negative definite, r³ and r² log r positive definite (Wendland 2005, theorems 8.16 and 8.17).
  const double sign = options.kernel == Kernel::biharmonic ? -1 : 1;

  const Spread spread = spread_of(data.point);
  const Eigen::Index q = 1 + spread.axis.cols();
  Eigen::MatrixXd p(n, q);
  for (std::size_t i = 0; i < n; ++i) {
    p(i, 0) = 1;
    for (Eigen::Index k = 1; k < q; ++k) p(i, k) = spread.axis.col(k - 1).dot(data.point[i] - spread.mean);
  }

  const Projected system = with_kernel(options.kernel, [&]<Kernel kernel>() {
    return projected_system<kernel>(soa, data.point, p, sign, options.smoothing);
  });

  // Solve, then refine once with the residual of the original system: the kernel matrices are badly conditioned.
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(n), coefficient = Eigen::VectorXd::Zero(q);
  const Eigen::VectorXd target = Eigen::Map<const Eigen::VectorXd>(data.value.data(), n);
  Eigen::VectorXd residual = target;
  const auto kernel_times = [&](const Eigen::VectorXd& x) {
    std::vector<double> padded_weight(padded(n), 0.0);
    std::copy(x.begin(), x.end(), padded_weight.begin());
    Eigen::VectorXd product(n);
    with_kernel(options.kernel, [&]<Kernel kernel>() {
      parallel_for(n, 64, [&](std::size_t i) {
        product[i] = sign * kernel_sum<kernel>(soa, padded_weight, data.point[i]) + options.smoothing * x[i];
      });
    });
    return product;
  };
  for (int round = 0; round < 2; ++round) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
    step.tail(n - q) = system.factor.solve(system.apply_transposed(residual).tail(n - q));
    step = system.apply(step);
    const Eigen::VectorXd rest = residual - kernel_times(step);
    weight += step;
    coefficient += system.r.triangularView<Eigen::Upper>().solve(system.apply_transposed(rest).head(q));
    residual = target - kernel_times(weight) - p * coefficient;
  }
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    worst = std::max(worst, std::abs(residual[i]));
    largest = std::max(largest, std::abs(target[i]));
  }
  if (!(worst <= 1e-6 * std::max(data.range, 1e-6 * largest)))
    throw SolverFailure("the radial basis system of " + std::to_string(n) +
                            " centres is singular; thin the centres or allow smoothing",
                        worst);

  for (std::size_t i = 0; i < n; ++i) result.weight_[i] = sign * weight[i];
  result.linear_ = Vec3d::Zero();
  for (Eigen::Index k = 1; k < q; ++k) result.linear_ += coefficient[k] * spread.axis.col(k - 1);
  result.constant_ = coefficient[0] - result.linear_.dot(spread.mean);
  return result;
}

double RadialBasis::value(const Vec3d& x) const {
  const Vec3d p = (x - origin_) * per_mm_;
  const Centers centers{x_, y_, z_};
  const double sum = with_kernel(kernel_, [&]<Kernel kernel>() { return kernel_sum<kernel>(centers, weight_, p); });
  return sum + ((linear_.x() * p.x() + linear_.y() * p.y()) + linear_.z() * p.z()) + constant_;
}

Vec3d RadialBasis::gradient(const Vec3d& x) const {
  const Vec3d p = (x - origin_) * per_mm_;
  const Centers centers{x_, y_, z_};
  const Vec3d sum =
      with_kernel(kernel_, [&]<Kernel kernel>() { return kernel_gradient<kernel>(centers, weight_, p); });
  return (sum + linear_) * per_mm_;
}

void RadialBasis::values(std::span<const Vec3d> points, std::span<double> result) const {
  parallel_for(points.size(), 256, [&](std::size_t i) { result[i] = value(points[i]); });
}

void RadialBasis::gradients(std::span<const Vec3d> points, std::span<Vec3d> result) const {
  parallel_for(points.size(), 256, [&](std::size_t i) { result[i] = gradient(points[i]); });
}

} // namespace pith
