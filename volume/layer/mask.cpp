// Splotch masks: Takayama et al. 2008, §5.2.1 (Fig. 11) and §5.2.7 (Figs. 13, 14).
#include "volume/layer/mask.h"

#include "volume/base/error.h"
#include "volume/base/random.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pith {

float Mask::value(const float* position) const {
  std::array<int, 3> low{}, high{};
  std::array<float, 3> fraction{};
  for (int axis = 0; axis < axes; ++axis) {
    const float p = position[axis];
    if (!open[axis] && !(p >= 0 && p <= 1)) return 0;
    const float at = std::clamp(p * size[axis] - 0.5f, 0.0f, static_cast<float>(size[axis] - 1));
    low[axis] = static_cast<int>(at);
    high[axis] = std::min(low[axis] + 1, size[axis] - 1);
    fraction[axis] = at - low[axis];
  }
  const auto row = [&](int y, int z) {
    const std::uint8_t* line = alpha.data() + (std::size_t(z) * size[1] + y) * size[0];
    return line[low[0]] + fraction[0] * (line[high[0]] - line[low[0]]);
  };
  const auto slice = [&](int z) {
    const float a = row(low[1], z);
    return a + fraction[1] * (row(high[1], z) - a);
  };
  const float a = slice(low[2]);
  const float value = axes == 3 ? a + fraction[2] * (slice(high[2]) - a) : a;
  return value * (1 / 255.0f);
}

namespace {

/// A smooth function on the sphere with values in about [−1, 1]: a few random plane waves.
double waviness(const Vec3d& direction, std::uint64_t seed) {
  double sum = 0;
  for (int wave = 0; wave < 6; ++wave) {
    Random random(seed, 0x5b107c4, wave);
    const Vec3d axis = Vec3d(random.normal(), random.normal(), random.normal()).normalized();
    sum += std::sin(4.5 * axis.dot(direction) + 2 * std::numbers::pi * random.uniform());
  }
  return sum / 3;
}

} // namespace

Mask splotch_mask(const SplotchOptions& o, SplotchPart part) {
  if (o.axes < 2 || o.axes > 3 || o.resolution < 4 || o.resolution > 256 || !(o.radius > 0) || !(o.radius_along > 0) ||
      !(o.drop_off > 0) || !(o.irregularity >= 0))
    throw InvalidInput("mask", "has a size that is not positive or a resolution outside 4 to 256",
                       "give 2 or 3 axes, a positive radius and drop-off, and an irregularity of at least 0");
  Mask mask;
  mask.axes = o.axes;
  for (int axis = 0; axis < o.axes; ++axis) mask.size[axis] = o.resolution;
  const bool varies = part != SplotchPart::whole;
  // Along the axis of variation the three parts share the depth range: their opaque cores overlap by the drop-off.
  Vec3d center(0.5, 0.5, 0.5), radius(o.radius, o.radius, o.radius);
  if (varies) {
    radius[o.variation_axis] = o.radius_along;
    if (part == SplotchPart::outer) center[o.variation_axis] = 0;
    if (part == SplotchPart::inner) center[o.variation_axis] = 1;
    mask.open[o.variation_axis] = part != SplotchPart::middle;
  }
  mask.alpha.resize(std::size_t(mask.size[0]) * mask.size[1] * mask.size[2]);
  std::size_t out = 0;
  for (int z = 0; z < mask.size[2]; ++z)
    for (int y = 0; y < mask.size[1]; ++y)
      for (int x = 0; x < mask.size[0]; ++x, ++out) {
        Vec3d p((x + 0.5) / mask.size[0], (y + 0.5) / mask.size[1], o.axes == 3 ? (z + 0.5) / mask.size[2] : 0.5);
        const Vec3d to = (p - center).cwiseQuotient(radius);
        const double length = to.norm();
        const Vec3d direction = length > 0 ? Vec3d(to / length) : Vec3d(1, 0, 0);
        const double border = 1 + o.irregularity / o.radius * waviness(direction, o.seed);
        // Distance inside the border, in texture widths (along the direction's own radius).
        const double inside = (border - length) * direction.cwiseProduct(radius).norm();
        const double t = std::clamp(inside / o.drop_off, 0.0, 1.0);
        mask.alpha[out] = static_cast<std::uint8_t>(std::lround(255 * t * t * (3 - 2 * t)));
      }
  return mask;
}

} // namespace pith
