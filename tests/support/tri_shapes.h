#pragma once
// Small closed surfaces whose measures are known.
#include "volume/mesh/tri_mesh.h"

#include <map>

namespace pith::testing {

/// The axis-aligned box from `low` to `high`: 8 vertices, 12 triangles, facing outwards.
inline TriMesh box_surface(const Vec3d& low, const Vec3d& high) {
  TriMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.position.push_back({i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z()});
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    mesh.corner.push_back({VertexId(q[0]), VertexId(q[1]), VertexId(q[2])});
    mesh.corner.push_back({VertexId(q[0]), VertexId(q[2]), VertexId(q[3])});
  }
  return mesh;
}

/// The unit octahedron, each triangle split in four `levels` times, pushed out to the sphere, scaled and moved.
inline TriMesh sphere_surface(int levels, double radius = 1, const Vec3d& center = Vec3d::Zero()) {
  TriMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) mesh.position.push_back(side * Vec3d::Unit(axis));
  const int faces[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (const auto& f : faces) mesh.corner.push_back({VertexId(f[0]), VertexId(f[1]), VertexId(f[2])});
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, VertexId> middles;
    const auto middle = [&](VertexId a, VertexId b) {
      const auto [at, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)}, VertexId(mesh.vertex_count()));
      if (fresh) mesh.position.push_back((mesh.position[a] + mesh.position[b]).normalized());
      return at->second;
    };
    PerTriangle<std::array<VertexId, 3>> finer;
    for (const auto& c : mesh.corner) {
      const VertexId ab = middle(c[0], c[1]), bc = middle(c[1], c[2]), ca = middle(c[2], c[0]);
      finer.push_back({c[0], ab, ca});
      finer.push_back({ab, c[1], bc});
      finer.push_back({ca, bc, c[2]});
      finer.push_back({ab, bc, ca});
    }
    mesh.corner = finer;
  }
  for (Vec3d& p : mesh.position) p = center + radius * p;
  return mesh;
}

/// Every triangle turned round.
inline TriMesh inside_out(TriMesh mesh) {
  for (auto& c : mesh.corner) std::swap(c[1], c[2]);
  return mesh;
}

/// Both meshes in one; b's triangles follow a's.
inline TriMesh together(const TriMesh& a, const TriMesh& b) {
  TriMesh both = a;
  const auto shift = static_cast<std::uint32_t>(a.vertex_count());
  both.position.insert(both.position.end(), b.position.begin(), b.position.end());
  for (const auto& c : b.corner)
    both.corner.push_back({VertexId(c[0] + shift), VertexId(c[1] + shift), VertexId(c[2] + shift)});
  return both;
}

} // namespace pith::testing
