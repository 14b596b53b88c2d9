// Rings of vertices around the axis, evenly spaced along the meridian and along each ring, are joined into strips of
// triangles; then edges are flipped towards valence six and the Delaunay condition (Lawson 1977), and vertices move
// to the centroid of their neighbours and back onto the shape, in turn, until the triangles are near-uniform.
#include "volume/exemplar/kiwi_surface.h"

#include "volume/base/error.h"
#include "volume/exemplar/edge_flips.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace pith {

namespace {

constexpr double pi = std::numbers::pi;

/// Half the fruit's extents along x, y, z before dimples and unevenness, mm.
const Vec3d half_extent(25.0, 23.0, 31.7);

struct Rings {
  std::vector<double> polar; ///< angle from +z, of each ring
  std::vector<int> vertices; ///< on each ring
  std::size_t triangles() const {
    std::size_t inner = 0;
    for (const int n : vertices) inner += n;
    return 2 * (inner + 2) - 4; // Euler, with the two ends
  }
};

Vec3d on_surface(const Vec3d& direction) {
  const Vec3d unit = direction.normalized();
  return unit * kiwi_surface_radius(unit);
}

Vec3d direction_of(double polar, double around) {
  return {std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar)};
}

/// Rings whose spacing along the meridian, and whose vertices' spacing, suit triangles of that edge.
Rings rings_for(double edge) {
  constexpr int samples = 2000;
  std::vector<double> length(samples + 1, 0.0);
  Vec3d before = on_surface(direction_of(0, pi / 4));
  for (int i = 1; i <= samples; ++i) {
    const Vec3d here = on_surface(direction_of(pi * i / samples, pi / 4));
    length[i] = length[i - 1] + (here - before).norm();
    before = here;
  }
  const int strips = std::max(4, int(std::lround(length[samples] / (edge * std::sqrt(0.75)))));
  Rings rings;
  for (int k = 1; k < strips; ++k) {
    const double wanted = length[samples] * k / strips;
    const auto after = std::upper_bound(length.begin(), length.end(), wanted);
    const std::size_t i = std::size_t(after - length.begin()) - 1;
    rings.polar.push_back(pi * (double(i) + (wanted - length[i]) / (length[i + 1] - length[i])) / samples);
    double around = 0;
    constexpr int sides = 64;
    for (int j = 0; j < sides; ++j)
      around += (on_surface(direction_of(rings.polar.back(), 2 * pi * j / sides)) -
                 on_surface(direction_of(rings.polar.back(), 2 * pi * (j + 1) / sides)))
                    .norm();
    rings.vertices.push_back(std::max(5, int(std::lround(around / edge))));
  }
  return rings;
}

/// Triangles between two closed rings of vertices: always the shorter of the two possible next edges.
void join(const std::vector<Vec3d>& position, std::uint32_t upper, int upper_count, std::uint32_t lower,
          int lower_count, std::vector<std::array<std::uint32_t, 3>>& corner) {
  int a = 0, b = 0;
  const auto top = [&](int i) { return upper + std::uint32_t(i % upper_count); };
  const auto bottom = [&](int i) { return lower + std::uint32_t(i % lower_count); };
  while (a < upper_count || b < lower_count) {
    const bool advance_top =
        b == lower_count || (a < upper_count && (position[top(a + 1)] - position[bottom(b)]).squaredNorm() <
                                                    (position[top(a)] - position[bottom(b + 1)]).squaredNorm());
    if (advance_top) {
      corner.push_back({top(a), bottom(b), top(a + 1)});
      ++a;
    } else {
      corner.push_back({top(a), bottom(b), bottom(b + 1)});
      ++b;
    }
  }
}

/// Every vertex but the two ends to the mean of its neighbours, and back onto the shape.
void relax(std::vector<Vec3d>& position, const std::vector<std::array<std::uint32_t, 3>>& corner) {
  struct Neighbors {
    Vec3d sum = Vec3d::Zero();
    double count = 0;
  };
  std::vector<Neighbors> around(position.size());
  for (const auto& c : corner)
    for (int i = 0; i < 3; ++i) {
      around[c[i]].sum += position[c[(i + 1) % 3]];
      around[c[i]].count += 1;
    }
  for (std::size_t v = 1; v + 1 < position.size(); ++v) position[v] = on_surface(around[v].sum / around[v].count);
}

} // namespace

double kiwi_surface_radius(const Vec3d& direction) {
  const double x = direction.x(), y = direction.y(), z = direction.z();
  // A superellipsoid of revolution but for the flattening: blunter than an ellipsoid along the axis.
  constexpr double exponent = 2.35;
  const double across = std::hypot(x / half_extent.x(), y / half_extent.y()), along = std::fabs(z) / half_extent.z();
  double radius = std::pow(std::pow(across, exponent) + std::pow(along, exponent), -1.0 / exponent);
  // The stem's end is a little broader than the other.
  radius *= 1.0 + 0.022 * z * (1.0 - z * z) * 2.6;
  // Slow unevenness: a few tenths of a millimetre, as three-sided and four-sided waves around and along.
  radius += 0.30 * std::sin(3.1 * x + 1.7 * y + 0.9) * std::cos(2.3 * z - 0.4) +
            0.22 * std::sin(4.3 * y - 2.9 * z + 2.2) +
            0.14 * std::sin(5.7 * x - 3.8 * z + 0.3) * std::sin(4.9 * y + 1.1);
  // Dimples, mm deep, with a soft rim; the ends of the stalk and of the flower.
  const double from_axis = std::hypot(x, y);
  const auto dimple = [&](double depth, double width) {
    const double t = from_axis * half_extent.z() / width;
    return depth * std::exp(-t * t);
  };
  radius -= z > 0 ? dimple(1.5, 4.2) : dimple(0.9, 3.4);
  return radius;
}

TriMesh kiwi_surface(int triangles) {
  if (triangles < 100 || triangles > 1000000)
    throw InvalidInput("kiwi surface", std::to_string(triangles) + " triangles", "give 100 to 1,000,000");

  // The edge length that gives the wanted count: counts grow as 1/edge², so a few corrections do; the nearest is
  // kept.
  double edge = std::sqrt(8600.0 / (triangles * std::sqrt(3.0) / 4));
  Rings rings = rings_for(edge);
  const auto miss = [&](const Rings& r) { return std::fabs(double(r.triangles()) - triangles); };
  edge *= std::sqrt(double(rings.triangles()) / triangles);
  for (int i = -12; i <= 12; ++i) {
    const Rings next = rings_for(edge * (1.0 + 0.004 * i));
    if (miss(next) < miss(rings)) rings = next;
  }

  std::vector<Vec3d> position{on_surface({0, 0, 1})};
  std::vector<std::uint32_t> first;
  for (std::size_t k = 0; k < rings.polar.size(); ++k) {
    first.push_back(std::uint32_t(position.size()));
    for (int j = 0; j < rings.vertices[k]; ++j) // every other ring is turned by half a step
      position.push_back(
          on_surface(direction_of(rings.polar[k], 2 * pi * (j + 0.5 * double(k % 2)) / rings.vertices[k])));
  }
  position.push_back(on_surface({0, 0, -1}));

  std::vector<std::array<std::uint32_t, 3>> corner;
  const std::uint32_t end = std::uint32_t(position.size()) - 1;
  for (int j = 0; j < rings.vertices.front(); ++j)
    corner.push_back({0, first.front() + j, first.front() + (j + 1) % rings.vertices.front()});
  for (std::size_t k = 0; k + 1 < first.size(); ++k)
    join(position, first[k], rings.vertices[k], first[k + 1], rings.vertices[k + 1], corner);
  for (int j = 0; j < rings.vertices.back(); ++j)
    corner.push_back({end, first.back() + (j + 1) % rings.vertices.back(), first.back() + j});

  constexpr int valence_rounds = 6, delaunay_rounds = 20, last_sweeps = 8;
  for (int round = 0; round < valence_rounds; ++round) {
    flip_edges(FlipFor::valence, position, corner);
    relax(position, corner);
  }
  for (int round = 0; round < delaunay_rounds; ++round) {
    flip_edges(FlipFor::delaunay, position, corner);
    relax(position, corner);
  }
  for (int sweep = 0; sweep < last_sweeps && flip_edges(FlipFor::delaunay, position, corner) > 0; ++sweep) {
  }

  TriMesh mesh;
  mesh.position.assign(position.begin(), position.end());
  for (const auto& c : corner) mesh.corner.push_back({VertexId(c[0]), VertexId(c[1]), VertexId(c[2])});
  return mesh;
}

} // namespace pith
