#include "volume/lap/thing.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>

namespace pith {

Occupancy occupancy_of(const Mask& mask, std::uint8_t above) {
  constexpr int n = Occupancy::cells;
  Occupancy result;
  result.cell.assign(n * n * n, 0);
  // Texel i reaches where it takes part in interpolation: (i − ½)/size … (i + 3/2)/size.
  const auto range = [](int i, int size) {
    const int first = static_cast<int>(std::floor((i - 0.5) / size * n));
    const int last = static_cast<int>(std::ceil((i + 1.5) / size * n)) - 1;
    return std::pair(std::max(0, first), std::min(n - 1, last));
  };
  std::size_t texel = 0;
  for (int k = 0; k < mask.size[2]; ++k)
    for (int j = 0; j < mask.size[1]; ++j)
      for (int i = 0; i < mask.size[0]; ++i, ++texel) {
        if (mask.alpha[texel] <= above) continue;
        const auto [x0, x1] = range(i, mask.size[0]);
        const auto [y0, y1] = range(j, mask.size[1]);
        const auto [z0, z1] = range(k, mask.size[2]);
        for (int z = z0; z <= z1; ++z)
          for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) result.cell[(z * n + y) * n + x] = 1;
      }
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        if (!result.cell[(z * n + y) * n + x]) continue;
        result.bounds.add(Vec3d(x, y, z) / n);
        result.bounds.add(Vec3d(x + 1, y + 1, z + 1) / n);
      }
  return result;
}

bool Occupancy::meets(const std::array<Vec3d, 4>& corner, int corners) const {
  constexpr double slack = 1e-9;
  Box box;
  for (int i = 0; i < corners; ++i) box.add(corner[i]);
  std::array<int, 3> low, high;
  for (int a = 0; a < 3; ++a) {
    const double from = std::max(box.low[a], bounds.low[a]) - slack,
                 to = std::min(box.high[a], bounds.high[a]) + slack;
    if (!(from <= to)) return false;
    low[a] = std::clamp(static_cast<int>(std::floor(from * cells)), 0, cells - 1);
    high[a] = std::clamp(static_cast<int>(std::floor(to * cells)), 0, cells - 1);
  }
  // Planes that a cell must not lie wholly outside of: the sides of a tet; of a triangle, both faces of its plane.
  std::array<Vec3d, 4> normal;
  std::array<double, 4> offset;
  int planes = 0;
  if (corners == 4) {
    for (int i = 0; i < 4; ++i) {
      const Vec3d &a = corner[(i + 1) % 4], &b = corner[(i + 2) % 4], &c = corner[(i + 3) % 4];
      Vec3d inward = (b - a).cross(c - a);
      if (inward.dot(corner[i] - a) < 0) inward = -inward;
      normal[planes] = inward;
      offset[planes++] = inward.dot(a);
    }
  } else {
    const Vec3d up = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    normal[0] = up, offset[0] = up.dot(corner[0]);
    normal[1] = -up, offset[1] = -offset[0];
    planes = 2;
  }
  std::array<double, 4> reach;
  for (int p = 0; p < planes; ++p) reach[p] = normal[p].cwiseAbs().sum() * (0.5 / cells + slack);
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x) {
        if (!cell[(z * cells + y) * cells + x]) continue;
        const Vec3d middle = Vec3d(x + 0.5, y + 0.5, z + 0.5) / cells;
        bool outside = false;
        for (int p = 0; p < planes && !outside; ++p) outside = normal[p].dot(middle) < offset[p] - reach[p];
        if (!outside) return true;
      }
  return false;
}

namespace {

/// Gives every texel of alpha 0 the mean of its neighbours that have a colour, a few rings far, and beyond them the
/// thing's mean, so that interpolation and coarser levels never mix in what is not there.
void continue_outwards(Exemplar& e, const LargeArray<std::uint8_t>& alpha) {
  constexpr int rings = 4;
  const int components = e.component_count();
  std::vector<std::uint8_t> known(alpha.size());
  for (std::size_t i = 0; i < alpha.size(); ++i) known[i] = alpha[i] > 0;
  const std::array<int, 3> n{e.size[0], e.size[1], e.size[2]};
  std::array<std::uint64_t, max_components> total{};
  std::uint64_t opaque = 0;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    if (!known[i]) continue;
    for (int c = 0; c < components; ++c) total[c] += e.texel[i * components + c];
    ++opaque;
  }
  std::vector<std::size_t> found;
  for (int ring = 0; ring < rings; ++ring) {
    found.clear();
    std::size_t at = 0;
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y)
        for (int x = 0; x < n[0]; ++x, ++at) {
          if (known[at]) continue;
          std::array<int, max_components> sum{};
          int count = 0;
          const auto take = [&](bool there, std::ptrdiff_t step) {
            if (!there || known[at + step] != 1) return;
            for (int c = 0; c < components; ++c) sum[c] += e.texel[(at + step) * components + c];
            ++count;
          };
          take(x > 0, -1), take(x + 1 < n[0], 1);
          take(y > 0, -n[0]), take(y + 1 < n[1], n[0]);
          take(z > 0, -std::ptrdiff_t(n[0]) * n[1]), take(z + 1 < n[2], std::ptrdiff_t(n[0]) * n[1]);
          if (count == 0) continue;
          for (int c = 0; c < components; ++c)
            e.texel[at * components + c] = static_cast<std::uint8_t>((2 * sum[c] + count) / (2 * count));
          known[at] = 2; // of this ring: not a source before the next
          found.push_back(at);
        }
    for (const std::size_t i : found) known[i] = 1;
  }
  for (std::size_t i = 0; i < alpha.size() && opaque > 0; ++i)
    for (int c = 0; c < components && !known[i]; ++c)
      e.texel[i * components + c] = static_cast<std::uint8_t>((2 * total[c] + opaque) / (2 * opaque));
}

} // namespace

Thing thing_of(const Exemplar& exemplar, const std::optional<SplotchOptions>& splotch) {
  validate(exemplar);
  const std::string where = "exemplar '" + exemplar.name + "'";
  if (exemplar.axes != 3) throw InvalidInput(where, "is not a volume", "paste things from volumes of 3 axes");
  Thing thing;
  int at = 0, alpha_at = -1;
  for (const Channel& c : exemplar.channel) {
    if (c.name == alpha_channel && c.components == 1 && alpha_at < 0)
      alpha_at = at;
    else
      thing.exemplar.channel.push_back(c);
    at += c.components;
  }
  if (alpha_at < 0 && !splotch)
    throw InvalidInput(where, "does not say where it is opaque",
                       "give it a channel \"alpha\", or a \"mask\" that cuts a piece out of it");
  if (thing.exemplar.channel.empty()) throw InvalidInput(where, "has nothing but alpha", "give it a colour");

  if (alpha_at >= 0) {
    Exemplar& e = thing.exemplar;
    e.name = exemplar.name;
    e.axes = 3;
    e.size = exemplar.size;
    e.wrap.fill(Wrap::clamp);
    const int components = exemplar.component_count();
    thing.mask.axes = 3;
    thing.mask.size = {exemplar.size[0], exemplar.size[1], exemplar.size[2]};
    thing.mask.alpha.reserve(exemplar.texel_count());
    e.texel.reserve(e.texel_count() * (components - 1));
    for (std::size_t i = 0; i < exemplar.texel_count(); ++i)
      for (int c = 0; c < components; ++c)
        (c == alpha_at ? thing.mask.alpha : e.texel).push_back(exemplar.texel[i * components + c]);
    continue_outwards(e, thing.mask.alpha);
  } else {
    thing.exemplar = exemplar;
    SplotchOptions options = *splotch;
    options.axes = 3;
    thing.mask = splotch_mask(options);
    thing.frame.scale.fill(static_cast<float>(splotch_extent(options, SplotchPart::whole)));
    for (int a = 0; a < 3; ++a) thing.frame.offset[a] = 0.5f - 0.5f * thing.frame.scale[a]; // middle to middle
  }

  const Mask& mask = thing.mask;
  double sum = 0;
  std::size_t texel = 0;
  for (int k = 0; k < mask.size[2]; ++k)
    for (int j = 0; j < mask.size[1]; ++j)
      for (int i = 0; i < mask.size[0]; ++i, ++texel) {
        sum += mask.alpha[texel];
        if (mask.alpha[texel] < 128) continue;
        const Vec3d size(mask.size[0], mask.size[1], mask.size[2]);
        thing.solid.add(Vec3d(i, j, k).cwiseQuotient(size));
        thing.solid.add(Vec3d(i + 1, j + 1, k + 1).cwiseQuotient(size));
      }
  if (thing.solid.empty()) throw InvalidInput(where, "is opaque nowhere", "its alpha must reach ½ somewhere");
  thing.volume = sum / 255 / static_cast<double>(mask.alpha.size());
  thing.any = occupancy_of(mask, 0);
  thing.half = occupancy_of(mask, 127);
  return thing;
}

} // namespace pith
