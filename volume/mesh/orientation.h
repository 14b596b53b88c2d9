#pragma once
// Exact orientation of four points: a floating-point filter, and exact arithmetic where the filter cannot decide.
#include "volume/base/types.h"

namespace pith {

namespace detail {
int exact_orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d);
}

/// +1 when det(b − a, c − a, d − a) > 0, −1 when < 0, 0 when the four points are coplanar. Exact for all finite input
/// whose products neither overflow nor underflow. The filter's bound is Shewchuk's (1997), orient3d stage A.
inline int orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const double ax = a.x() - d.x(), ay = a.y() - d.y(), az = a.z() - d.z();
  const double bx = b.x() - d.x(), by = b.y() - d.y(), bz = b.z() - d.z();
  const double cx = c.x() - d.x(), cy = c.y() - d.y(), cz = c.z() - d.z();
  const double bxcy = bx * cy, cxby = cx * by, cxay = cx * ay, axcy = ax * cy, axby = ax * by, bxay = bx * ay;
  const double determinant = az * (bxcy - cxby) + bz * (cxay - axcy) + cz * (axby - bxay);
  const double permanent = (std::abs(bxcy) + std::abs(cxby)) * std::abs(az) +
                           (std::abs(cxay) + std::abs(axcy)) * std::abs(bz) +
                           (std::abs(axby) + std::abs(bxay)) * std::abs(cz);
  constexpr double epsilon = 0x1.0p-53;
  constexpr double bound = (7 + 56 * epsilon) * epsilon;
  // det(a − d, b − d, c − d) has the opposite sign of det(b − a, c − a, d − a).
  if (determinant > bound * permanent) return -1;
  if (-determinant > bound * permanent) return 1;
  return detail::exact_orientation(a, b, c, d);
}

} // namespace pith
