#pragma once
// A tetrahedral mesh with adjacency.
#include "volume/base/types.h"

#include <span>

namespace pith {

/// Corners of the facet opposite corner i of a positively oriented tet, counter-clockwise seen from outside.
inline constexpr std::array<std::array<int, 3>, 4> facet_corners = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// Tets are positively oriented: det(p1 − p0, p2 − p0, p3 − p0) > 0.
struct TetMesh {
  PerVertex<Vec3d> position;                      ///< millimetres
  PerTet<std::array<VertexId, 4>> corner;
  PerTet<std::array<TetId, 4>> neighbor;          ///< neighbor[t][i] shares the facet opposite corner i; none outside
  PerTet<std::int32_t> region;                    ///< one number per closed input shell, 0, 1, 2 ...

  std::size_t vertex_count() const { return position.size(); }
  std::size_t tet_count() const { return corner.size(); }
};

/// Fills `neighbor` from `corner`. O(n) with one sort. Throws InvalidInput when a facet has more than two tets.
void connect(TetMesh& mesh);

double signed_volume(const TetMesh& mesh, TetId tet);
std::array<Vec3d, 4> barycentric_gradients(const TetMesh& mesh, TetId tet); ///< 1/mm; not finite in a flat tet
Vec3d barycenter(const TetMesh& mesh, TetId tet);
Box bounds_of(const TetMesh& mesh);

/// Throws InvalidInput, naming the first offender, unless corners are in range, all volumes are positive, neighbours are
/// symmetric and positions finite.
void validate(const TetMesh& mesh);

/// For each vertex the tets around it, ascending: compressed rows.
struct VertexTets {
  std::vector<std::uint32_t> begin; ///< vertex_count + 1
  std::vector<TetId> tet;
  std::span<const TetId> operator[](VertexId v) const { return {tet.data() + begin[v], tet.data() + begin[v + 1]}; }
};
VertexTets tets_around_vertices(const TetMesh& mesh);

/// For each vertex the vertices that share an edge with it, ascending: compressed rows.
struct VertexNeighbors {
  std::vector<std::uint32_t> begin;
  std::vector<VertexId> vertex;
  std::span<const VertexId> operator[](VertexId v) const {
    return {vertex.data() + begin[v], vertex.data() + begin[v + 1]};
  }
};
VertexNeighbors vertices_around_vertices(const TetMesh& mesh);

} // namespace pith
