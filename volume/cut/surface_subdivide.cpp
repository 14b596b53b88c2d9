#include "volume/cut/surface_subdivide.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <string>

namespace pith {

namespace {

constexpr std::size_t block = 4096; // faces
constexpr std::uint32_t whole = 0xffffffffu;

using Edge = std::uint64_t; // the lower point in the upper half: ascending edges run along the points

Edge edge_between(std::uint32_t a, std::uint32_t b) { return std::uint64_t(std::min(a, b)) << 32 | std::max(a, b); }

Vec3f middle(const Vec3f& a, const Vec3f& b) {
  const Vec3f sum = a + b;
  const float length = sum.norm();
  return length > 0 ? Vec3f(sum / length) : a;
}

/// Appends the two to four parts of a face; middle[i] is the midpoint of the edge from corner i to the next, or
/// `whole`.
void split(const SurfaceFace& face, const std::array<std::uint32_t, 3>& mid, const std::vector<Vec3d>& position,
           std::vector<SurfaceFace>& result) {
  const auto part = [&](std::array<std::pair<std::uint32_t, Vec3f>, 3> corner) {
    SurfaceFace& f = result.emplace_back(face);
    for (int i = 0; i < 3; ++i) {
      f.point[i] = corner[i].first;
      f.normal[i] = corner[i].second;
    }
  };
  const auto corner = [&](int i) { return std::pair(face.point[i % 3], face.normal[i % 3]); };
  const auto half = [&](int i) {
    return std::pair(mid[i % 3], middle(face.normal[i % 3], face.normal[(i + 1) % 3]));
  };
  const int count = int(mid[0] != whole) + int(mid[1] != whole) + int(mid[2] != whole);
  if (count == 0) {
    result.push_back(face);
  } else if (count == 1) {
    int i = 0;
    while (mid[i] == whole) ++i;
    part({corner(i), half(i), corner(i + 2)});
    part({half(i), corner(i + 1), corner(i + 2)});
  } else if (count == 2) {
    int i = 0; // the edge that stays whole runs from corner i to the next
    while (mid[i] != whole) ++i;
    part({half(i + 1), corner(i + 2), half(i + 2)});
    // The quadrilateral that is left is split along its shorter diagonal.
    const double one = (position[face.point[i]] - position[mid[(i + 1) % 3]]).squaredNorm();
    const double other = (position[face.point[(i + 1) % 3]] - position[mid[(i + 2) % 3]]).squaredNorm();
    if (one <= other) {
      part({corner(i), corner(i + 1), half(i + 1)});
      part({corner(i), half(i + 1), half(i + 2)});
    } else {
      part({corner(i), corner(i + 1), half(i + 2)});
      part({corner(i + 1), half(i + 1), half(i + 2)});
    }
  } else {
    for (int i = 0; i < 3; ++i) part({corner(i), half(i), half(i + 2)});
    part({half(0), half(1), half(2)});
  }
}

} // namespace

void subdivide(std::vector<Vec3d>& position, std::vector<SurfaceFace>& face, double max_edge,
               std::size_t max_triangles, const std::function<bool(const SurfaceFace&)>& asks, const char* where) {
  const double longest = max_edge * max_edge;
  const auto refuse = [&](double count) {
    char text[96];
    std::snprintf(text, sizeof text, "%.3g mm makes %.3g triangles or more, beyond the limit of %.3g", max_edge,
                  count, static_cast<double>(max_triangles));
    throw InvalidInput(where, text, "give a longer edge");
  };
  // Without an edge that is longer, a triangle has at most the area √3/4 · max_edge²: so many parts at least.
  double least = 0;
  for (const SurfaceFace& f : face) {
    const Vec3d &a = position[f.point[0]], &b = position[f.point[1]], &c = position[f.point[2]];
    least += asks && !asks(f) ? 1 : std::max(1.0, (b - a).cross(c - a).norm() / longest);
  }
  if (least > static_cast<double>(max_triangles)) refuse(least);
  const auto too_long = [&](std::uint32_t a, std::uint32_t b) {
    return (position[a] - position[b]).squaredNorm() > longest;
  };
  for (;;) {
    std::vector<Edge> edge;
    std::size_t parts = face.size();
    for (const SurfaceFace& f : face) {
      if (asks && !asks(f)) continue;
      for (int i = 0; i < 3; ++i)
        if (too_long(f.point[i], f.point[(i + 1) % 3])) {
          edge.push_back(edge_between(f.point[i], f.point[(i + 1) % 3]));
          ++parts;
        }
    }
    if (edge.empty()) return;
    if (parts > max_triangles) refuse(static_cast<double>(parts));
    std::sort(edge.begin(), edge.end());
    edge.erase(std::unique(edge.begin(), edge.end()), edge.end());
    const auto first = static_cast<std::uint32_t>(position.size());
    for (const Edge e : edge) {
      // a + b rounds alike in both orders, and so does its half.
      const Vec3d mid = 0.5 * (position[e >> 32] + position[e & 0xffffffffu]);
      position.push_back(mid);
    }

    // Blocks of faces are split side by side and joined in order.
    std::vector<std::vector<SurfaceFace>> part((face.size() + block - 1) / block);
    parallel_blocks(face.size(), block, [&](std::size_t begin, std::size_t end) {
      auto& result = part[begin / block];
      for (std::size_t f = begin; f < end; ++f) {
        std::array<std::uint32_t, 3> mid = {whole, whole, whole};
        for (int i = 0; i < 3; ++i) {
          const std::uint32_t a = face[f].point[i], b = face[f].point[(i + 1) % 3];
          if (!too_long(a, b)) continue;
          const auto at = std::lower_bound(edge.begin(), edge.end(), edge_between(a, b));
          if (at == edge.end() || *at != edge_between(a, b)) continue; // no face that asks has it
          mid[i] = first + static_cast<std::uint32_t>(at - edge.begin());
        }
        split(face[f], mid, position, result);
      }
    });
    face.clear();
    for (const auto& result : part) face.insert(face.end(), result.begin(), result.end());
  }
}

} // namespace pith
