#pragma once
// Sums of radial kernels over many centres in linear time (private to the field module).
#include "volume/field/chebyshev_box.h"
#include "volume/field/octree.h"

namespace pith {

/// Σ wᵢ k(|x − cᵢ|) for k = r or r³ by the fast multipole method. The same bits on any number of threads. The error
/// is below 10⁻⁹ of the largest sum for random weights.
class KernelSum {
public:
  KernelSum(Kernel kernel, std::span<const Vec3d> centers);

  /// The sums at the centres themselves; with `wanted`, only where it is not 0 (the rest is left alone).
  void at_centers(std::span<const double> weight, std::span<double> result,
                  std::span<const std::uint8_t> wanted = {}) const;

  /// Fixes the weights for value() and gradient().
  void hold(std::span<const double> weight);
  double value(const Vec3d& x) const; ///< inside the tree ~1 µs; far outside it some 10 µs
  Vec3d gradient(const Vec3d& x) const;

private:
  using Moments = std::vector<Series>;
  std::vector<double> in_slots(std::span<const double> weight) const;
  Moments moments_of(const std::vector<double>& slot_weight) const;
  /// The series of every leaf with target set; of others it may hold anything.
  Moments series_of(const Moments& moments, const std::vector<std::uint8_t>& target) const;
  void far_fields(const Moments& moments, std::span<const std::uint32_t> target, Moments& series) const;
  template <class NearBox, class FarNode>
  void outside(std::uint32_t box, const Vec3d& x, const NearBox& near, const FarNode& far) const;
  Vec3d local(const OctreeBox& box, const Vec3d& x) const;
  Centers centers() const { return {x_.data(), y_.data(), z_.data()}; }

  Kernel kernel_;
  Octree tree_;
  FarOperators far_;
  std::vector<double> x_, y_, z_; ///< of the centres, in slots
  std::vector<double> weight_;    ///< held, in slots
  Moments moments_, series_;      ///< held
};

} // namespace pith
