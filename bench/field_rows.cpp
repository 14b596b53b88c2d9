// rbf/*: radial basis functions through 100,000 centres.
#include "bench/row.h"
#include "volume/base/random.h"
#include "volume/field/radial_basis.h"

#include <fmt/format.h>

namespace pith::bench {
namespace {

/// Centres over a closed, wavy surface about 90 mm long, a little irregularly, with smooth values.
struct Samples {
  std::vector<Vec3d> center;
  std::vector<double> value;
  double range = 0;
};

Samples surface_samples(int count) {
  Samples samples;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - 2 * (i + 0.5) / count, r = std::sqrt(1 - z * z);
    const double angle = i * 2.399963229728653 + Random(7, i).uniform(-1, 1) / std::sqrt(count) / std::max(r, 0.05);
    const Vec3d d(r * std::cos(angle), r * std::sin(angle), z);
    const double radius = 20 * (1 + 0.25 * std::sin(3 * d.x() + 1) * std::cos(4 * d.y()) + 0.1 * std::sin(7 * d.z()));
    const Vec3d x = radius * Vec3d(1.5 * d.x(), d.y(), 0.8 * d.z());
    samples.center.push_back(x);
    samples.value.push_back(std::sin(0.1 * x.x()) * std::cos(0.07 * x.y()) + 0.02 * x.z());
  }
  const auto [low, high] = std::minmax_element(samples.value.begin(), samples.value.end());
  samples.range = *high - *low;
  return samples;
}

std::vector<Vec3d> places_inside(const std::vector<Vec3d>& surface, std::size_t count) {
  std::vector<Vec3d> places(count);
  for (std::size_t i = 0; i < count; ++i) {
    Random random(9, i);
    const Vec3d& p = surface[random.below(static_cast<std::uint32_t>(surface.size()))];
    places[i] = random.uniform(0, 1.02) * p;
  }
  return places;
}

Measured fit_row(const Settings& settings) {
  // A 4k subset, solved both ways.
  Samples some = surface_samples(4000);
  const RadialBasis fast = RadialBasis::fit(some.center, some.value, {.method = RadialMethod::fast});
  const RadialBasis dense = RadialBasis::fit(some.center, some.value, {.method = RadialMethod::dense});
  double difference = 0;
  for (const Vec3d& x : places_inside(some.center, 10'000))
    difference = std::max(difference, std::abs(fast.value(x) - dense.value(x)));

  const Samples all = surface_samples(100'000);
  double residual = 0;
  const double seconds =
      median_seconds(settings.times(3), {}, [&] { residual = RadialBasis::fit(all.center, all.value).residual(); });
  return {seconds,
          fmt::format("triharmonic; largest miss at a centre {:.2g} of the range; 4,000 centres, 10,000 other "
                      "points: {:.2g} of the range from the dense solution",
                      residual / all.range, difference / some.range)};
}

Measured evaluation_row(const Settings& settings) {
  const Samples all = surface_samples(100'000);
  const RadialBasis basis = RadialBasis::fit(all.center, all.value);
  const std::vector<Vec3d> places = places_inside(all.center, 1'000'000);
  std::vector<double> result(places.size());
  std::vector<Vec3d> gradient(places.size());
  const double seconds = median_seconds(settings.times(3), {}, [&] { basis.values(places, result); });
  const double with_gradients = seconds_of([&] { basis.gradients(places, gradient); });
  return {seconds, fmt::format("values, random inside; gradients {:.3g} s", with_gradients)};
}

} // namespace

std::vector<Row> field_rows() {
  return {{"rbf/fit_100k", "s", "≤ 40", fit_row}, {"rbf/eval_100k_1m", "s", "≤ 4", evaluation_row}};
}

} // namespace pith::bench
