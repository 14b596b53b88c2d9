#pragma once
// Small tet meshes for tests: a box and a ball, cut from cubes.
#include "volume/mesh/tet_mesh.h"

#include <algorithm>
#include <cmath>

namespace pith {

namespace detail {

/// nx × ny × nz cubes, each split into six tets along one diagonal (Kuhn). `mirrored(i, j, k)` tells along which axes
/// the diagonal of a cube runs backwards.
template <class Mirrored>
TetMesh split_cubes(int nx, int ny, int nz, const Mirrored& mirrored) {
  TetMesh mesh;
  const auto vertex = [&](int i, int j, int k) { return VertexId((k * (ny + 1) + j) * (nx + 1) + i); };
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) mesh.position.push_back({double(i), double(j), double(k)});
  constexpr int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const std::array<bool, 3> back = mirrored(i, j, k);
        for (const auto& order : orders) {
          // From the cube's first corner to the opposite one, one axis after the other.
          std::array<int, 3> at = {back[0] ? 1 : 0, back[1] ? 1 : 0, back[2] ? 1 : 0};
          std::array<VertexId, 4> corner;
          corner[0] = vertex(i + at[0], j + at[1], k + at[2]);
          for (int step = 0; step < 3; ++step) {
            at[order[step]] = 1 - at[order[step]];
            corner[step + 1] = vertex(i + at[0], j + at[1], k + at[2]);
          }
          const Vec3d &o = mesh.position[corner[0]], a = mesh.position[corner[1]] - o,
                      b = mesh.position[corner[2]] - o, c = mesh.position[corner[3]] - o;
          Mat3d edges;
          edges << a, b, c;
          if (edges(0, 0) * (edges(1, 1) * edges(2, 2) - edges(1, 2) * edges(2, 1)) -
                  edges(0, 1) * (edges(1, 0) * edges(2, 2) - edges(1, 2) * edges(2, 0)) +
                  edges(0, 2) * (edges(1, 0) * edges(2, 1) - edges(1, 1) * edges(2, 0)) <
              0)
            std::swap(corner[2], corner[3]);
          mesh.corner.push_back(corner);
        }
      }
  mesh.region.assign(mesh.tet_count(), 0);
  return mesh;
}

} // namespace detail

/// A box [0, nx·size] × [0, ny·size] × [0, nz·size] of 6 nx ny nz conforming, connected, positively oriented tets of
/// region 0. Vertex (i, j, k) has the number (k (ny + 1) + j) (nx + 1) + i.
inline TetMesh tet_grid(int nx, int ny, int nz, double size = 1) {
  TetMesh mesh = detail::split_cubes(nx, ny, nz, [](int, int, int) { return std::array<bool, 3>{}; });
  for (Vec3d& p : mesh.position) p *= size;
  connect(mesh);
  return mesh;
}

/// A ball around the origin: a grid of n³ cubes (n rounded up to even) warped radially. The cubes' diagonals run
/// outwards, so that no tet has all corners on the skin; there is a vertex at the origin and there are vertices along
/// the axes.
inline TetMesh tet_ball(int n, double radius = 1) {
  n += n % 2;
  const int half = n / 2;
  TetMesh mesh = detail::split_cubes(n, n, n, [half](int i, int j, int k) {
    return std::array<bool, 3>{i < half, j < half, k < half};
  });
  for (Vec3d& p : mesh.position) {
    p = p / half - Vec3d::Ones();
    const double length = p.norm();
    if (length > 0) p *= radius * p.cwiseAbs().maxCoeff() / length;
  }
  connect(mesh);
  return mesh;
}

} // namespace pith
