// Splotch masks: Takayama et al. 2008, §5.2.1 (Fig. 11) and §5.2.7 (Figs. 13, 14).
#include "volume/layer/mask.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pith {

namespace {

/// A smooth function on the sphere with values in about [−1, 1]: a few random plane waves.
class Waviness {
public:
  explicit Waviness(std::uint64_t seed) {
    for (std::size_t wave = 0; wave < axis_.size(); ++wave) {
      Random random(seed, 0x5b107c4, wave);
      const double x = random.normal(), y = random.normal(), z = random.normal();
      axis_[wave] = 4.5 * Vec3d(x, y, z).normalized();
      phase_[wave] = 2 * std::numbers::pi * random.uniform();
    }
  }
  double operator()(const Vec3d& direction) const {
    double sum = 0;
    for (std::size_t wave = 0; wave < axis_.size(); ++wave)
      sum += std::sin(axis_[wave].dot(direction) + phase_[wave]);
    return sum / 3;
  }

private:
  std::array<Vec3d, 6> axis_;
  std::array<double, 6> phase_;
};

} // namespace

double splotch_extent(const SplotchOptions& o, SplotchPart part) {
  return 2 * ((part == SplotchPart::outer ? o.radius_outer : o.radius) + o.irregularity);
}

Mask splotch_mask(const SplotchOptions& o, SplotchPart part) {
  if (o.axes < 2 || o.axes > 3 || o.resolution < 4 || o.resolution > 256 || !(o.radius > 0) ||
      !(o.radius_outer > 0) || !(o.radius_along > 0) || !(o.reach_outer > 0) || !(o.reach_inner > 0) ||
      !(o.drop_off > 0) || !(o.irregularity >= 0) || o.endless_axis < -1 || o.endless_axis >= o.axes)
    throw InvalidInput(
        "mask", "has a size that is not positive or a resolution outside 4 to 256",
        "give 2 or 3 axes, a positive radius and drop-off, an irregularity of at least 0, and an axis that "
        "the mask has");
  Mask mask;
  mask.axes = o.axes;
  for (int axis = 0; axis < o.axes; ++axis) mask.size[axis] = o.resolution;
  const bool varies = part != SplotchPart::whole;
  // In texture widths: across the variation the cube spans `extent` around 0, along it [0, 1].
  const double extent = splotch_extent(o, part), across = part == SplotchPart::outer ? o.radius_outer : o.radius;
  Vec3d center(0, 0, 0), radius(across, across, across);
  if (varies) {
    radius[o.variation_axis] = part == SplotchPart::middle  ? o.radius_along
                               : part == SplotchPart::outer ? o.reach_outer
                                                            : o.reach_inner;
    center[o.variation_axis] = part == SplotchPart::outer ? 0 : part == SplotchPart::inner ? 1 : 0.5;
    mask.open[o.variation_axis] = part != SplotchPart::middle;
  }
  if (o.endless_axis >= 0) mask.open[o.endless_axis] = true;
  const Waviness waviness(o.seed);
  mask.alpha.resize(std::size_t(mask.size[0]) * mask.size[1] * mask.size[2]);
  parallel_for(mask.size[2], 1, [&](std::size_t slice) {
    const int z = static_cast<int>(slice);
    std::size_t out = slice * mask.size[0] * mask.size[1];
    for (int y = 0; y < mask.size[1]; ++y)
      for (int x = 0; x < mask.size[0]; ++x, ++out) {
        Vec3d p((x + 0.5) / mask.size[0], (y + 0.5) / mask.size[1], o.axes == 3 ? (z + 0.5) / mask.size[2] : 0.5);
        for (int axis = 0; axis < 3; ++axis)
          if (!varies || axis != o.variation_axis) p[axis] = (p[axis] - 0.5) * extent;
        Vec3d to = (p - center).cwiseQuotient(radius);
        double along = 0; // an endless axis does not count for how far inside a place is, only for the waves
        if (o.endless_axis >= 0) {
          along = to[o.endless_axis];
          to[o.endless_axis] = 0;
        }
        const double length = to.norm();
        const Vec3d direction = length > 0 ? Vec3d(to / length) : Vec3d(1, 0, 0);
        Vec3d wave = direction;
        if (o.endless_axis >= 0) wave[o.endless_axis] = along;
        const double border = 1 + o.irregularity / across * waviness(wave);
        // Distance inside the border, in texture widths (along the direction's own radius).
        const double inside = (border - length) * direction.cwiseProduct(radius).norm();
        const double t = std::clamp(inside / o.drop_off, 0.0, 1.0);
        mask.alpha[out] = static_cast<std::uint8_t>(std::lround(255 * t * t * (3 - 2 * t)));
      }
  });
  return mask;
}

} // namespace pith
