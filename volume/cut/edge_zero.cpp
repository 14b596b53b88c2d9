#include "volume/cut/edge_zero.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pith {

EdgeNumbers::EdgeNumbers(std::size_t most) {
  const std::size_t slots = std::bit_ceil(2 * most + 2);
  slot_.assign(slots, empty);
  shift_ = 64 - std::countr_zero(slots);
}

double zero_on_edge(const LevelSet* level_set, const Rigid& placement, const Vec3d& a, const Vec3d& b, double value_a,
                    double value_b, double snap) {
  double t = value_a / (value_a - value_b);
  if (level_set && !level_set->linear()) {
    const double enough = 1e-10 * std::max(std::abs(value_a), std::abs(value_b));
    double low = 0, high = 1, at_low = value_a, at_high = value_b;
    int kept = 0; // the end that stayed in the last step
    for (int step = 0; step < 10; ++step) {
      t = (low * at_high - high * at_low) / (at_high - at_low);
      if (!(t > low && t < high)) t = 0.5 * (low + high);
      const double at = level_set->value(placement(a + t * (b - a)));
      if (!(std::abs(at) > enough)) break;
      if ((at > 0) == (at_low > 0)) {
        low = t;
        at_low = at;
        if (kept > 0) at_high *= 0.5;
        kept = 1;
      } else {
        high = t;
        at_high = at;
        if (kept < 0) at_low *= 0.5;
        kept = -1;
      }
    }
  }
  return std::clamp(t, snap, 1 - snap);
}

} // namespace pith
