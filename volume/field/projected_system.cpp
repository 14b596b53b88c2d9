// The symmetric indefinite system of radial basis functions with a polynomial, solved where it is definite: Wendland:
// Scattered data approximation, 2005, §8.3; the compact form of the reflectors: Schreiber, Van Loan 1989.
#include "volume/field/projected_system.h"

#include "volume/base/parallel.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace pith {

Eigen::MatrixXd Spread::polynomials_at(std::span<const Vec3d> point) const {
  Eigen::MatrixXd p(point.size(), polynomials());
  for (std::size_t i = 0; i < point.size(); ++i) {
    p(i, 0) = 1;
    for (Eigen::Index k = 1; k < p.cols(); ++k) p(i, k) = axis.col(k - 1).dot(point[i] - mean);
  }
  return p;
}

Spread spread_of(std::span<const Vec3d> point, double flat) {
  Spread spread;
  for (const Vec3d& p : point) spread.mean += p;
  spread.mean /= static_cast<double>(point.size());
  Mat3d covariance = Mat3d::Zero();
  for (const Vec3d& p : point) covariance += (p - spread.mean) * (p - spread.mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3d> eigen(covariance);
  const double largest = eigen.eigenvalues()[2];
  int used = 0;
  for (int k = 0; k < 3; ++k)
    if (eigen.eigenvalues()[k] > flat * largest && largest > 0) ++used;
  spread.axis = eigen.eigenvectors().rightCols(used);
  return spread;
}

ProjectedSystem::ProjectedSystem(Kernel kernel, std::span<const Vec3d> point, const Eigen::MatrixXd& p,
                                 double smoothing) {
  const Eigen::Index n = p.rows(), q = p.cols();
  const double sign = definite_sign(kernel);
  // Householder QR of P, its reflectors gathered into the compact form.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(p);
  r = qr.matrixQR().topRows(q).triangularView<Eigen::Upper>();
  v = Eigen::MatrixXd::Zero(n, q);
  t = Eigen::MatrixXd::Zero(q, q);
  for (Eigen::Index k = 0; k < q; ++k) {
    v(k, k) = 1;
    v.col(k).tail(n - k - 1) = qr.matrixQR().col(k).tail(n - k - 1);
    const double tau = qr.hCoeffs()[k];
    t(k, k) = tau;
    if (k > 0) {
      const Eigen::VectorXd inner = v.leftCols(k).transpose() * v.col(k);
      t.col(k).head(k) = -tau * (t.topLeftCorner(k, k) * inner);
    }
  }

  // ±K + λ by columns, and Y = (±K + λ) V. Full columns: both need them.
  const Eigen::Index rows = static_cast<Eigen::Index>(padded(n));
  std::vector<double> x(rows, 0.0), y(rows, 0.0), z(rows, 0.0);
  for (Eigen::Index i = 0; i < n; ++i) {
    x[i] = point[i].x();
    y[i] = point[i].y();
    z[i] = point[i].z();
  }
  const Centers centers{x.data(), y.data(), z.data()};
  Eigen::MatrixXd k(rows, n), kv(q, n), v_rows = Eigen::MatrixXd::Zero(rows, q);
  v_rows.topRows(n) = v;
  with_kernel(kernel, [&]<Kernel chosen>() {
    parallel_for(n, 16, [&](std::size_t j) {
      for (Eigen::Index i = 0; i < rows; i += lanes)
        k.col(j).template segment<lanes>(i) =
            (sign * kernel_of<chosen>(centers.squared_distance(i, point[j]))).matrix();
      k(j, j) += smoothing;
      for (Eigen::Index c = 0; c < q; ++c) {
        Lane sum = Lane::Zero();
        for (Eigen::Index i = 0; i < rows; i += lanes)
          sum += k.col(j).template segment<lanes>(i).array() * v_rows.col(c).template segment<lanes>(i).array();
        kv(c, j) = sum_of(sum);
      }
    });
  });

  // Qᵀ (±K + λ) Q = (±K + λ) − W Vᵀ − V Wᵀ with W = Y T − V Tᵀ (Vᵀ Y) T / 2.
  const Eigen::MatrixXd yt = kv.transpose() * t;
  const Eigen::MatrixXd w = yt - 0.5 * v * (t.transpose() * (v.transpose() * yt));
  const Eigen::Index m = n - q;
  Eigen::MatrixXd definite(m, m);
  parallel_for(m, 16, [&](std::size_t j) {
    const Eigen::Index length = m - static_cast<Eigen::Index>(j);
    auto column = definite.col(j).tail(length);
    column = k.col(q + j).segment(q + j, length);
    for (Eigen::Index c = 0; c < q; ++c)
      column -= w.col(c).tail(length) * v(q + j, c) + v.col(c).tail(length) * w(q + j, c);
  });
  factor = TiledCholesky(std::move(definite));
}

Eigen::MatrixXd ProjectedSystem::weights(const Eigen::MatrixXd& right) const {
  const Eigen::Index q = v.cols(), rest = v.rows() - q;
  Eigen::MatrixXd step = Eigen::MatrixXd::Zero(v.rows(), right.cols());
  const Eigen::MatrixXd turned = right - v * (t.transpose() * (v.transpose() * right));
  step.bottomRows(rest) = factor.solve(turned.bottomRows(rest));
  return step - v * (t * (v.transpose() * step));
}

Eigen::VectorXd ProjectedSystem::coefficients(const Eigen::VectorXd& rest) const {
  const Eigen::VectorXd turned = rest - v * (t.transpose() * (v.transpose() * rest));
  return r.triangularView<Eigen::Upper>().solve(turned.head(v.cols()));
}

} // namespace pith
