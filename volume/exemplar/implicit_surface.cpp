// Surface nets (Gibson 1998): one vertex in each cell of a grid that the surface passes through, one quadrilateral
// for each edge of the grid that it crosses. Then edges are flipped (Lawson 1977), and vertices move to the centroid
// of their neighbours and back onto the surface, in turn.
#include "volume/exemplar/implicit_surface.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/exemplar/edge_flips.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pith {

namespace {

using Corners = std::vector<std::array<std::uint32_t, 3>>;

Vec3d gradient_at(const ImplicitShape& shape, const Vec3d& p, double step) {
  Vec3d g;
  for (int a = 0; a < 3; ++a) {
    Vec3d up = p, down = p;
    up[a] += step;
    down[a] -= step;
    g[a] = (shape.value(up) - shape.value(down)) / (2 * step);
  }
  return g;
}

/// The point moved onto the surface along the gradient, by no more than an edge a step.
Vec3d projected(const ImplicitShape& shape, Vec3d p, double edge) {
  for (int i = 0; i < 8; ++i) {
    const double value = shape.value(p);
    const Vec3d g = gradient_at(shape, p, 1e-3 * edge);
    const double squared = g.squaredNorm();
    if (!(squared > 0)) return p;
    Vec3d move = -value / squared * g;
    const double length = move.norm();
    if (length > edge) move *= edge / length;
    p += move;
    if (length < 1e-6 * edge) break;
  }
  return p;
}

struct Net {
  std::vector<Vec3d> position;
  Corners corner;
};

/// The net over a grid whose place is the `attempt`-th of a list.
Net surface_net(const ImplicitShape& shape, double cell, int attempt, const std::string& where) {
  std::array<int, 3> n;
  for (int a = 0; a < 3; ++a) n[a] = int(std::ceil((shape.high[a] - shape.low[a]) / cell)) + 4;
  const Vec3d shift(1.487 + 0.137 * (attempt % 4), 1.521 - 0.173 * (attempt % 5), 1.509 + 0.117 * (attempt % 3));
  const auto at = [&](int i, int j, int k) {
    return Vec3d(shape.low + cell * (Vec3d(i, j, k) - shift)); // off the planes of symmetry
  };
  const auto index = [&](int i, int j, int k) { return (std::size_t(k) * n[1] + j) * n[0] + i; };
  std::vector<double> value(std::size_t(n[0]) * n[1] * n[2]);
  parallel_for(std::size_t(n[2]), 1, [&](std::size_t k) {
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const double v = shape.value(at(i, j, int(k)));
        value[index(i, j, int(k))] = v == 0 ? 1e-12 : v;
      }
  });

  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
        if ((i == 0 || j == 0 || k == 0 || i + 1 == n[0] || j + 1 == n[1] || k + 1 == n[2]) &&
            value[index(i, j, k)] < 0) {
          const Vec3d p = at(i, j, k);
          throw InvalidInput(where,
                             "reaches its box near (" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " +
                                 std::to_string(p.z()) + ")",
                             "make the box larger");
        }

  Net net;
  std::vector<std::uint32_t> vertex(value.size(), 0xffffffffu);
  for (int k = 0; k + 1 < n[2]; ++k)
    for (int j = 0; j + 1 < n[1]; ++j)
      for (int i = 0; i + 1 < n[0]; ++i) {
        Vec3d sum = Vec3d::Zero();
        int crossings = 0;
        const auto edge = [&](int i0, int j0, int k0, int i1, int j1, int k1) {
          const double a = value[index(i0, j0, k0)], b = value[index(i1, j1, k1)];
          if ((a < 0) == (b < 0)) return;
          sum += at(i0, j0, k0) + a / (a - b) * (at(i1, j1, k1) - at(i0, j0, k0));
          ++crossings;
        };
        for (int u = 0; u < 2; ++u)
          for (int v = 0; v < 2; ++v) {
            edge(i, j + u, k + v, i + 1, j + u, k + v);
            edge(i + u, j, k + v, i + u, j + 1, k + v);
            edge(i + u, j + v, k, i + u, j + v, k + 1);
          }
        if (crossings == 0) continue;
        vertex[index(i, j, k)] = std::uint32_t(net.position.size());
        net.position.push_back(sum / crossings);
      }

  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, bool turned) {
    if (turned) std::swap(b, d);
    if ((net.position[a] - net.position[c]).squaredNorm() <= (net.position[b] - net.position[d]).squaredNorm()) {
      net.corner.push_back({a, b, c});
      net.corner.push_back({a, c, d});
    } else {
      net.corner.push_back({a, b, d});
      net.corner.push_back({b, c, d});
    }
  };
  for (int k = 1; k + 1 < n[2]; ++k)
    for (int j = 1; j + 1 < n[1]; ++j)
      for (int i = 1; i + 1 < n[0]; ++i) {
        const bool inside = value[index(i, j, k)] < 0;
        const auto v = [&](int a, int b, int c) { return vertex[index(a, b, c)]; };
        if (inside != (value[index(i + 1, j, k)] < 0))
          quad(v(i, j - 1, k - 1), v(i, j, k - 1), v(i, j, k), v(i, j - 1, k), !inside);
        if (inside != (value[index(i, j + 1, k)] < 0))
          quad(v(i - 1, j, k - 1), v(i - 1, j, k), v(i, j, k), v(i, j, k - 1), !inside);
        if (inside != (value[index(i, j, k + 1)] < 0))
          quad(v(i - 1, j - 1, k), v(i, j - 1, k), v(i, j, k), v(i - 1, j, k), !inside);
      }
  return net;
}

/// Whether every edge has two triangles that run through it in opposite directions. Where the surface is nearly flat
/// along a plane of the grid, as on a rim, a saddle can make a cell hold two sheets, whose vertices are one.
bool is_manifold(const Net& net) {
  std::vector<std::uint64_t> directed;
  directed.reserve(3 * net.corner.size());
  for (const auto& c : net.corner)
    for (int i = 0; i < 3; ++i) directed.push_back((std::uint64_t(c[i]) << 32) | c[(i + 1) % 3]);
  std::sort(directed.begin(), directed.end());
  if (std::adjacent_find(directed.begin(), directed.end()) != directed.end()) return false;
  // One fan of triangles around each vertex: as many edges, corners and vertices as closed surfaces have is not
  // enough, so fans are walked.
  std::vector<std::uint32_t> corners(net.position.size(), 0), first(net.position.size(), 0xffffffffu);
  for (std::uint32_t t = 0; t < net.corner.size(); ++t)
    for (const std::uint32_t v : net.corner[t]) ++corners[v], first[v] = t;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> of_edge;
  for (std::uint32_t t = 0; t < net.corner.size(); ++t)
    for (int i = 0; i < 3; ++i)
      of_edge.push_back({(std::uint64_t(net.corner[t][i]) << 32) | net.corner[t][(i + 1) % 3], t});
  std::sort(of_edge.begin(), of_edge.end());
  for (std::uint32_t v = 0; v < net.position.size(); ++v) {
    if (corners[v] == 0) return false;
    std::uint32_t t = first[v], walked = 0;
    do {
      const auto& c = net.corner[t];
      const int i = int(std::find(c.begin(), c.end(), v) - c.begin());
      const std::uint64_t next = (std::uint64_t(v) << 32) | c[(i + 2) % 3];
      const auto found = std::lower_bound(of_edge.begin(), of_edge.end(), std::pair(next, std::uint32_t(0)));
      if (found == of_edge.end() || found->first != next) return false;
      t = found->second;
    } while (++walked < corners[v] && t != first[v]);
    if (walked != corners[v] || t != first[v]) return false;
  }
  return true;
}

} // namespace

TriMesh implicit_surface(const ImplicitShape& shape, int triangles, const std::string& where) {
  if (triangles < 100 || triangles > 1000000)
    throw InvalidInput(where, std::to_string(triangles) + " triangles", "give 100 to 1,000,000");

  // The cell whose net has the wanted count: counts grow as 1/cell².
  const Vec3d extent = shape.high - shape.low;
  double cell = std::cbrt(extent.x() * extent.y() * extent.z()) / 24;
  Net net = surface_net(shape, cell, 0, where);
  if (net.corner.empty()) throw InvalidInput(where, "has no inside", "check its function and box");
  const auto miss = [&](const Net& one) { return std::fabs(double(one.corner.size()) / triangles - 1); };
  Net next = net;
  double wanted = cell;
  for (int i = 0; i < 8 && miss(net) > 0.02; ++i) {
    wanted *= std::sqrt(double(next.corner.size()) / triangles);
    next = surface_net(shape, wanted, 0, where);
    if (miss(next) < miss(net)) net = next, cell = wanted;
  }
  constexpr int attempts = 12;
  for (int attempt = 1; !is_manifold(net); ++attempt) {
    if (attempt == attempts)
      throw InvalidInput(where, "has features finer than " + std::to_string(triangles) + " triangles can show",
                         "ask for more triangles");
    net = surface_net(shape, cell, attempt, where);
  }

  const double edge = 1.2 * cell;
  const std::size_t count = net.position.size();
  const auto relax = [&](double share) {
    std::vector<Vec3d> sum(count, Vec3d::Zero());
    std::vector<double> around(count, 0.0);
    for (const auto& c : net.corner)
      for (int i = 0; i < 3; ++i) {
        sum[c[i]] += net.position[c[(i + 1) % 3]];
        around[c[i]] += 1;
      }
    parallel_for(count, 256, [&](std::size_t v) {
      const Vec3d wanted = net.position[v] + share * (sum[v] / around[v] - net.position[v]);
      net.position[v] = projected(shape, wanted, edge);
    });
  };
  relax(0.0);
  constexpr int valence_rounds = 6, delaunay_rounds = 14, last_sweeps = 8;
  for (int round = 0; round < valence_rounds; ++round) {
    flip_edges(FlipFor::valence, net.position, net.corner);
    relax(0.6);
  }
  for (int round = 0; round < delaunay_rounds; ++round) {
    flip_edges(FlipFor::delaunay, net.position, net.corner);
    relax(0.6);
  }
  for (int sweep = 0; sweep < last_sweeps && flip_edges(FlipFor::delaunay, net.position, net.corner) > 0; ++sweep) {
  }

  TriMesh mesh;
  mesh.position.assign(net.position.begin(), net.position.end());
  for (const auto& c : net.corner) mesh.corner.push_back({VertexId(c[0]), VertexId(c[1]), VertexId(c[2])});
  return mesh;
}

double smooth_union(double a, double b, double width) {
  const double t = std::max(width - std::fabs(a - b), 0.0) / width;
  return std::min(a, b) - t * t * width / 4;
}

double smooth_intersection(double a, double b, double width) { return -smooth_union(-a, -b, width); }

} // namespace pith
