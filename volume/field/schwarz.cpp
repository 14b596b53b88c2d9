// Domain decomposition for radial basis functions: Beatson, Light, Billings: Fast solution of the radial basis
// function interpolation equations: domain decomposition methods, 2000 (§3: inner points of overlapping domains, then
// a coarse problem on what is left).
//
// Departure: the rows of each domain's inverse that are used are kept as they are, in single precision; domains
// overlap by nearest centres rather than by enlarged boxes.
#include "volume/field/schwarz.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/field/farthest_points.h"

#include <algorithm>
#include <numeric>

namespace pith {
namespace {

/// Parts of at most `most` points each, by halving along the longest side.
std::vector<std::vector<std::uint32_t>> parts_of(std::span<const Vec3d> point, std::size_t most) {
  std::vector<std::uint32_t> all(point.size());
  std::iota(all.begin(), all.end(), 0u);
  std::vector<std::vector<std::uint32_t>> open = {std::move(all)}, done;
  while (!open.empty()) {
    std::vector<std::uint32_t> part = std::move(open.back());
    open.pop_back();
    if (part.size() <= most) {
      done.push_back(std::move(part));
      continue;
    }
    Box box;
    for (const std::uint32_t i : part) box.add(point[i]);
    int axis = 0;
    box.extent().maxCoeff(&axis);
    const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
    std::nth_element(part.begin(), middle, part.end(), [&](std::uint32_t a, std::uint32_t b) {
      return point[a][axis] != point[b][axis] ? point[a][axis] < point[b][axis] : a < b;
    });
    open.emplace_back(middle, part.end());
    open.emplace_back(part.begin(), middle);
  }
  return done;
}

double squared_gap(const Box& a, const Box& b) {
  return (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0.0).squaredNorm();
}

/// A part with the nearest points of others, up to `size` in all.
std::vector<std::uint32_t> with_neighbors(std::span<const Vec3d> point,
                                          const std::vector<std::vector<std::uint32_t>>& parts,
                                          const std::vector<Box>& box, std::size_t own, std::size_t size) {
  std::vector<std::uint32_t> member = parts[own];
  const std::size_t missing = size > member.size() ? size - member.size() : 0;
  std::vector<std::pair<double, std::uint32_t>> order;
  for (std::uint32_t p = 0; p < parts.size(); ++p)
    if (p != own) order.emplace_back(squared_gap(box[own], box[p]), p);
  std::sort(order.begin(), order.end());
  std::vector<std::pair<double, std::uint32_t>> candidate;
  for (const auto& [gap, p] : order) {
    if (candidate.size() >= 4 * missing) break;
    for (const std::uint32_t i : parts[p]) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const std::uint32_t j : parts[own]) nearest = std::min(nearest, (point[i] - point[j]).squaredNorm());
      candidate.emplace_back(nearest, i);
    }
  }
  const std::size_t taken = std::min(missing, candidate.size());
  std::nth_element(candidate.begin(), candidate.begin() + static_cast<std::ptrdiff_t>(taken), candidate.end());
  candidate.resize(taken);
  std::sort(candidate.begin(), candidate.end());
  for (const auto& [distance, i] : candidate) member.push_back(i);
  return member;
}

std::vector<Vec3d> points_at(std::span<const Vec3d> point, std::span<const std::uint32_t> index) {
  std::vector<Vec3d> result;
  for (const std::uint32_t i : index) result.push_back(point[i]);
  return result;
}

/// The system of some of the points, pulled towards the definite where they nearly coincide: a preconditioner may.
ProjectedSystem robust_system(Kernel kernel, std::span<const Vec3d> point, double smoothing) {
  const Eigen::MatrixXd p = spread_of(point, 1e-10).polynomials_at(point);
  Box box;
  for (const Vec3d& x : point) box.add(x);
  const double d = box.diagonal(), scale = kernel == Kernel::biharmonic ? d : d * d * d;
  for (double extra = 0;; extra = extra == 0 ? 1e-13 : 100 * extra) {
    try {
      return ProjectedSystem(kernel, point, p, smoothing + extra * scale);
    } catch (const SolverFailure&) {
      if (extra > 1e-3) throw;
    }
  }
}

} // namespace

Schwarz::Schwarz(const KernelSum& sum, Kernel kernel, std::span<const Vec3d> point,
                 const Eigen::MatrixXd& orthonormal, const SchwarzOptions& options)
    : sum_(sum), sign_(definite_sign(kernel)), smoothing_(options.smoothing), orthonormal_(orthonormal) {
  const auto parts = parts_of(point, options.inner);
  std::vector<Box> box(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const std::uint32_t i : parts[p]) box[p].add(point[i]);
  domain_.resize(parts.size());
  parallel_for(parts.size(), 1, [&](std::size_t d) {
    Domain& domain = domain_[d];
    domain.member = with_neighbors(point, parts, box, d, options.domain);
    domain.own = static_cast<std::uint32_t>(parts[d].size());
    const Eigen::Index size = static_cast<Eigen::Index>(domain.member.size());
    const ProjectedSystem system = robust_system(kernel, points_at(point, domain.member), smoothing_);
    domain.inverse = system.weights(Eigen::MatrixXd::Identity(size, domain.own)).transpose().cast<float>();
  });

  coarse_ = farthest_points(point, options.coarse);
  std::sort(coarse_.begin(), coarse_.end());
  is_coarse_.assign(point.size(), 0);
  for (const std::uint32_t i : coarse_) is_coarse_[i] = 1;
  coarse_system_.emplace(robust_system(kernel, points_at(point, coarse_), smoothing_));
}

Eigen::VectorXd Schwarz::apply(const Eigen::VectorXd& residual) const {
  Eigen::VectorXd step = Eigen::VectorXd::Zero(residual.size());
  parallel_for(domain_.size(), 4, [&](std::size_t d) {
    const Domain& domain = domain_[d];
    Eigen::VectorXf local(domain.member.size());
    for (std::size_t i = 0; i < domain.member.size(); ++i) local[i] = static_cast<float>(residual[domain.member[i]]);
    const Eigen::VectorXf own = domain.inverse * local;
    for (std::uint32_t i = 0; i < domain.own; ++i) step[domain.member[i]] = own[i];
  });
  step -= orthonormal_ * (orthonormal_.transpose() * step);

  Eigen::VectorXd product = Eigen::VectorXd::Zero(residual.size());
  sum_.at_centers({step.data(), std::size_t(step.size())}, {product.data(), std::size_t(product.size())}, is_coarse_);
  Eigen::VectorXd rest(coarse_.size());
  for (std::size_t i = 0; i < coarse_.size(); ++i) {
    const std::uint32_t at = coarse_[i];
    rest[i] = residual[at] - sign_ * product[at] - smoothing_ * step[at];
  }
  const Eigen::VectorXd correction = coarse_system_->weights(rest);
  for (std::size_t i = 0; i < coarse_.size(); ++i) step[coarse_[i]] += correction[i];
  return step;
}

} // namespace pith
