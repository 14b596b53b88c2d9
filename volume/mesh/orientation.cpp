#include "volume/mesh/orientation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace pith::detail {

int exact_orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const auto point = [](const Vec3d& p) { return Kernel::Point_3(p.x(), p.y(), p.z()); };
  return static_cast<int>(CGAL::orientation(point(a), point(b), point(c), point(d)));
}

} // namespace pith::detail
