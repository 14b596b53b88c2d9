#pragma once
// Scattered data interpolation by radial basis functions with a linear polynomial (Turk, O'Brien 1999).
#include "volume/base/types.h"

#include <span>

namespace pith {

enum class Kernel {
  biharmonic,  ///< r: 3D
  triharmonic, ///< r³: the thin-plate energy's smooth interpolant in 3D
  thin_plate   ///< r² log r: the 2D thin plate (use points with z = 0)
};

struct RadialBasisOptions {
  Kernel kernel = Kernel::triharmonic;
  double smoothing = 0;      ///< added to the diagonal, in units of the scaled kernel; 0 interpolates
  double merge = 1e-9;       ///< centres closer than this fraction of the extent are merged (their values averaged)
};

/// Σ wᵢ k(|x − cᵢ|) + a·x + b. Centres are scaled to the unit box inside, for conditioning.
class RadialBasis {
public:
  /// Dense solve, O(n³): 1,000 centres ~30 ms, 4,000 ~1.4 s. Throws InvalidInput when points are not finite, fewer than
  /// one, or values differ at merged points by more than their merge radius explains; SolverFailure when the system is singular.
  static RadialBasis fit(std::span<const Vec3d> centers, std::span<const double> values,
                         const RadialBasisOptions& options = {});

  double value(const Vec3d& x) const;
  Vec3d gradient(const Vec3d& x) const;
  void values(std::span<const Vec3d> points, std::span<double> result) const; ///< in parallel, bit-equal to value()
  void gradients(std::span<const Vec3d> points, std::span<Vec3d> result) const;
  std::size_t center_count() const { return x_.size(); }

private:
  Kernel kernel_ = Kernel::triharmonic;
  Vec3d origin_ = Vec3d::Zero();
  double per_mm_ = 1;
  std::vector<double> x_, y_, z_, weight_; ///< structure of arrays: evaluation dominates
  Vec3d linear_ = Vec3d::Zero();
  double constant_ = 0;
};

} // namespace pith
