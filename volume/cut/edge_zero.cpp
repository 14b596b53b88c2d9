#include "volume/cut/edge_zero.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pith {
namespace {

/// A step's error is about the product of the last two steps, times the ends' distance, times a small constant of the
/// field's curvature: so the last step needs no value of its own.
constexpr double enough = 1e-6;

struct Sample {
  double t, value;
};

/// Where the quadratic t(value) through three samples is at value 0; not finite when two values agree.
double inverse_quadratic(const Sample& a, const Sample& b, const Sample& c) {
  const double ab = a.value - b.value, bc = b.value - c.value, ca = c.value - a.value;
  return -(a.t * b.value * c.value / (ab * ca) + b.t * c.value * a.value / (bc * ab) +
           c.t * a.value * b.value / (ca * bc));
}

} // namespace

EdgeNumbers::EdgeNumbers(std::size_t most) {
  const std::size_t slots = std::bit_ceil(2 * most + 2);
  slot_.assign(slots, empty);
  shift_ = 64 - std::countr_zero(slots);
}

double zero_on_edge(const LevelSet* level_set, const Rigid& placement, const Vec3d& a, const Vec3d& b, double value_a,
                    double value_b, double snap) {
  double t = value_a / (value_a - value_b);
  if (level_set && !level_set->linear()) {
    const double small = 1e-13 * std::max(std::abs(value_a), std::abs(value_b));
    Sample older{0, value_a}, old{1, value_b};
    double low = 0, high = 1, last_step = 1;
    for (int step = 0; step < 12; ++step) {
      const Sample now{t, level_set->value(placement(a + t * (b - a)))};
      if (!(std::abs(now.value) > small)) break;
      ((now.value > 0) == (value_a > 0) ? low : high) = t;
      t = inverse_quadratic(older, old, now);
      if (!(t > low && t < high)) t = 0.5 * (low + high);
      const double this_step = std::abs(t - now.t);
      if (this_step * last_step < enough) break;
      last_step = this_step;
      older = old;
      old = now;
    }
  }
  return std::clamp(t, snap, 1 - snap);
}

} // namespace pith
