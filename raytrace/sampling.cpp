// The pixel filter's table.
#include "raytrace/sampling.h"

namespace pith {

namespace {
constexpr double filter_radius = 1.5;

/// Integral of the four-term Blackman–Harris window over [−radius, x], as a fraction of the whole.
double window_integral(double x) {
  const double t = (x + filter_radius) / (2 * filter_radius);
  constexpr double a[4] = {0.35875, 0.48829, 0.14128, 0.01168};
  constexpr double pi = std::numbers::pi;
  return t + (-a[1] * std::sin(2 * pi * t) / (2 * pi) + a[2] * std::sin(4 * pi * t) / (4 * pi) -
              a[3] * std::sin(6 * pi * t) / (6 * pi)) /
                 a[0];
}
} // namespace

PixelFilter::PixelFilter() {
  for (std::size_t i = 0; i < inverse_.size(); ++i) {
    const double wanted = double(i) / (inverse_.size() - 1);
    double low = -filter_radius, high = filter_radius;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (window_integral(middle) < wanted ? low : high) = middle;
    }
    inverse_[i] = 0.5 * (low + high);
  }
}

double PixelFilter::offset(double u) const {
  const double at = u * (inverse_.size() - 1);
  const std::size_t i = std::min(inverse_.size() - 2, static_cast<std::size_t>(at));
  return inverse_[i] + (at - i) * (inverse_[i + 1] - inverse_[i]);
}

} // namespace pith
