#pragma once
// The kernels of radial_basis.h, eight distances at a time (private to the field module).
#include "volume/field/radial_basis.h"

#include <Eigen/Core>

namespace pith {

inline constexpr std::size_t lanes = 8;
using Lane = Eigen::Array<double, lanes, 1>;

inline std::size_t padded(std::size_t count) { return (count + lanes - 1) / lanes * lanes; }

inline Lane load(const double* at) { return Eigen::Map<const Lane>(at); }

/// The lanes' sum in one fixed order.
inline double sum_of(const Lane& l) { return ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7])); }

/// r² log r = r² log(r²) / 2, continuous at 0.
inline constexpr double smallest_square = 1e-300;

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

/// r is conditionally negative definite, r³ and r² log r positive definite (Wendland 2005, theorems 8.16 and 8.17).
inline double definite_sign(Kernel kernel) { return kernel == Kernel::biharmonic ? -1 : 1; }

/// Centres as a structure of arrays (evaluation dominates), padded to whole lanes.
struct Centers {
  const double *x, *y, *z;

  Lane squared_distance(std::size_t at, const Vec3d& p) const {
    const Lane dx = p.x() - load(x + at), dy = p.y() - load(y + at), dz = p.z() - load(z + at);
    return dx * dx + dy * dy + dz * dz;
  }
};

/// Adds wᵢ k(|p − cᵢ|) for i in [begin, end), whole lanes.
template <Kernel kernel>
void add_kernels(const Centers& centers, const double* weight, std::size_t begin, std::size_t end, const Vec3d& p,
                 Lane& sum) {
  for (std::size_t i = begin; i < end; i += lanes)
    sum += load(weight + i) * kernel_of<kernel>(centers.squared_distance(i, p));
}

/// Sums of the three components of a gradient.
struct LaneGradient {
  Lane x = Lane::Zero(), y = Lane::Zero(), z = Lane::Zero();
  Vec3d sum() const { return {sum_of(x), sum_of(y), sum_of(z)}; }
};

/// Adds the gradients of wᵢ k(|p − cᵢ|) for i in [begin, end), whole lanes.
template <Kernel kernel>
void add_gradients(const Centers& centers, const double* weight, std::size_t begin, std::size_t end, const Vec3d& p,
                   LaneGradient& sum) {
  for (std::size_t i = begin; i < end; i += lanes) {
    const Lane dx = p.x() - load(centers.x + i), dy = p.y() - load(centers.y + i), dz = p.z() - load(centers.z + i);
    const Lane slope = load(weight + i) * slope_of<kernel>(dx * dx + dy * dy + dz * dz);
    sum.x += slope * dx;
    sum.y += slope * dy;
    sum.z += slope * dz;
  }
}

} // namespace pith
