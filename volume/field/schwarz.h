#pragma once
// A preconditioner for large radial basis systems by overlapping domains (private to the field module; Beatson,
// Light, Billings 2000).
#include "volume/field/kernel_sum.h"
#include "volume/field/projected_system.h"

#include <optional>

namespace pith {

struct SchwarzOptions {
  std::size_t inner = 160;   ///< centres that a domain owns, at most
  std::size_t domain = 400;  ///< centres that it solves for: its own and the nearest others
  std::size_t coarse = 2500; ///< centres of the coarse problem
  double smoothing = 0;      ///< the system's
};

/// Approximate solutions of Π(±K + λ) w = r for residuals r = Π r, where Π takes away linear functions.
class Schwarz {
public:
  Schwarz(const KernelSum& sum, Kernel kernel, std::span<const Vec3d> point, const Eigen::MatrixXd& orthonormal,
          const SchwarzOptions& options);

  Eigen::VectorXd apply(const Eigen::VectorXd& residual) const;

private:
  struct Domain {
    std::vector<std::uint32_t> member; ///< the first are its own
    std::uint32_t own = 0;
    Eigen::MatrixXf inverse; ///< own × member: the rows of the domain's solution that are used
  };
  const KernelSum& sum_;
  double sign_, smoothing_;
  const Eigen::MatrixXd& orthonormal_; ///< columns that span the linear functions at all points
  std::vector<Domain> domain_;
  std::vector<std::uint32_t> coarse_;
  std::vector<std::uint8_t> is_coarse_;
  std::optional<ProjectedSystem> coarse_system_;
};

} // namespace pith
