#include "volume/exemplar/edge_flips.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

namespace pith {

namespace {

double cotangent(const Vec3d& at, const Vec3d& p, const Vec3d& q) {
  const Vec3d u = p - at, v = q - at;
  return u.dot(v) / u.cross(v).norm();
}

} // namespace

int flip_edges(FlipFor aim, const std::vector<Vec3d>& position, std::vector<std::array<std::uint32_t, 3>>& corner) {
  struct Side {
    std::uint64_t edge;
    std::uint32_t triangle;
    bool operator<(const Side& o) const { return edge != o.edge ? edge < o.edge : triangle < o.triangle; }
  };
  std::vector<Side> sides;
  std::vector<int> valence(position.size(), 0);
  for (std::uint32_t t = 0; t < corner.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const std::uint64_t a = corner[t][i], b = corner[t][(i + 1) % 3];
      sides.push_back({(std::min(a, b) << 32) | std::max(a, b), t});
      ++valence[a];
    }
  std::sort(sides.begin(), sides.end());
  std::vector<char> touched(corner.size(), 0);
  const auto has_edge = [&](std::uint64_t edge) {
    const auto at = std::lower_bound(sides.begin(), sides.end(), Side{edge, 0});
    return at != sides.end() && at->edge == edge;
  };
  const auto normal = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) -> Vec3d {
    return (position[b] - position[a]).cross(position[c] - position[a]).normalized();
  };
  std::set<std::uint64_t> made; // edges that this sweep added
  int flips = 0;
  for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
    const std::uint32_t t = sides[i].triangle, u = sides[i + 1].triangle;
    if (touched[t] || touched[u]) continue;
    const std::uint32_t low = std::uint32_t(sides[i].edge >> 32), high = std::uint32_t(sides[i].edge);
    const auto opposite = [&](std::uint32_t triangle) {
      for (const std::uint32_t v : corner[triangle])
        if (v != low && v != high) return v;
      return low;
    };
    const std::uint32_t c = opposite(t), d = opposite(u);
    if (aim == FlipFor::valence) {
      const auto surplus = [](int count) { return (count - 6) * (count - 6); };
      const int before = surplus(valence[low]) + surplus(valence[high]) + surplus(valence[c]) + surplus(valence[d]);
      const int after =
          surplus(valence[low] - 1) + surplus(valence[high] - 1) + surplus(valence[c] + 1) + surplus(valence[d] + 1);
      if (after >= before) continue;
    } else {
      if (valence[low] <= 5 || valence[high] <= 5 || valence[c] >= 7 || valence[d] >= 7) continue;
      const double cotangents = cotangent(position[c], position[low], position[high]) +
                                cotangent(position[d], position[low], position[high]);
      if (cotangents >= -1e-9) continue;
    }
    const std::uint64_t crossing = (std::uint64_t(std::min(c, d)) << 32) | std::max(c, d);
    if (has_edge(crossing) || made.count(crossing) > 0) continue;
    // (a, b, c) runs through the edge a → b; the other triangle through b → a.
    const auto& corners = corner[t];
    const int at = int(std::find(corners.begin(), corners.end(), c) - corners.begin());
    const std::uint32_t a = corners[(at + 1) % 3], b = corners[(at + 2) % 3];
    const Vec3d before = normal(a, b, c) + normal(b, a, d);
    if (before.dot(normal(c, a, d)) < 0.5 * before.norm() || before.dot(normal(d, b, c)) < 0.5 * before.norm())
      continue;
    corner[t] = {c, a, d};
    corner[u] = {d, b, c};
    --valence[low], --valence[high], ++valence[c], ++valence[d];
    made.insert(crossing);
    touched[t] = touched[u] = 1;
    ++flips;
  }
  return flips;
}

} // namespace pith
