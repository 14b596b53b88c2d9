#pragma once
// Scattered data interpolation by radial basis functions with a linear polynomial (Turk, O'Brien 1999).
#include "volume/base/types.h"

#include <memory>
#include <span>

namespace pith {

enum class Kernel {
  biharmonic,  ///< r: 3D
  triharmonic, ///< r³: the thin-plate energy's smooth interpolant in 3D
  thin_plate   ///< r² log r: the 2D thin plate (use points with z = 0)
};

/// How a radial basis is fitted and evaluated.
enum class RadialMethod {
  automatic, ///< fast from 4,000 centres on, where it is (biharmonic, triharmonic)
  dense,     ///< every centre with every other, to the last digits
  fast       ///< fast multipole sums and an iteration, to a stated error
};

struct RadialBasisOptions {
  Kernel kernel = Kernel::triharmonic;
  /// Added to the diagonal of the (definite) system, in units of the scaled kernel; 0 interpolates.
  double smoothing = 0;
  /// Centres closer than this fraction of the extent are merged: the first stays, the values are averaged.
  double merge = 1e-9;
  RadialMethod method = RadialMethod::automatic;
  /// Fast: the iteration stops where no centre misses its value by more than this fraction of the values' range.
  double accuracy = 1e-7;
};

class KernelSum;

/// s(x) = Σ wᵢ k(|x − cᵢ|) + a·x + b. Centres are scaled to the unit box inside, for conditioning. The polynomial is
/// linear along the directions in which the centres spread and constant across (all centres in one plane, on one
/// line): such data are valid.
class RadialBasis {
public:
  /// The same bits on any number of threads.
  /// Dense: O(n³/3) on all threads: 500 centres ~5 ms, 1,500 ~60 ms, 4,000 ~0.5 s.
  /// Fast: near O(n log n), some 200 MB for 100,000 centres, which take ~12 s on two cores, and 10⁶ evaluations ~1 s.
  /// Between the centres it differs from the dense solution by some 10⁻⁶ of the values' range where these are smooth
  /// (on 6,000 centres of a closed surface 2·10⁻⁷, gradients by 3·10⁻⁶ of the largest).
  /// Errors: InvalidInput when there is no centre, a number is not finite, or (without smoothing) values at merged
  /// centres differ by more than a slope of 1,000 value ranges per extent across the merge radius explains, or the
  /// fast method is asked for with r² log r; SolverFailure when the system is singular or its residual stays above
  /// 10⁻⁶ of the values' range.
  static RadialBasis fit(std::span<const Vec3d> centers, std::span<const double> values,
                         const RadialBasisOptions& options = {});

  double value(const Vec3d& x) const;
  Vec3d gradient(const Vec3d& x) const;                                         ///< analytic, per mm
  void values(std::span<const Vec3d> points, std::span<double> result) const;   ///< in parallel, bit-equal to value()
  void gradients(std::span<const Vec3d> points, std::span<Vec3d> result) const; ///< bit-equal to gradient()
  std::size_t center_count() const { return count_; }                           ///< after merging
  bool fast() const { return fast_ != nullptr; }
  double residual() const { return residual_; } ///< the largest miss at a centre

private:
  Kernel kernel_ = Kernel::triharmonic;
  Vec3d origin_ = Vec3d::Zero();
  double per_mm_ = 1;
  std::size_t count_ = 0;
  double residual_ = 0;
  /// Structure of arrays (evaluation dominates), padded with zeros to a whole number of lanes. Dense only.
  std::vector<double> x_, y_, z_, weight_;
  std::shared_ptr<const KernelSum> fast_; ///< instead of them
  Vec3d linear_ = Vec3d::Zero();
  double constant_ = 0;
};

} // namespace pith
