// Adjacency and checks of tetrahedral meshes.
#include "volume/mesh/tet_mesh.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

namespace pith {
namespace {

/// One side of a facet, filed under its smallest corner.
struct FacetSide {
  std::uint32_t middle, high; ///< the two larger corners
  std::uint32_t side;         ///< 4 · tet + corner opposite
};

std::string text_of(std::size_t number) { return std::to_string(number); }

[[noreturn]] void refuse(const std::string& what) {
  throw InvalidInput("tet mesh", what, "mesh the surface again or repair the file it came from");
}

} // namespace

void connect(TetMesh& mesh) {
  const std::size_t tets = mesh.tet_count();
  mesh.neighbor.assign(tets, {});

  // Counting sort of the facets by their smallest corner; inside a bucket (a few dozen) by the other two.
  std::vector<std::uint32_t> begin(mesh.vertex_count() + 1, 0);
  const auto corners_of = [&](std::size_t t, int i) {
    const auto& corner = mesh.corner[TetId(t)];
    std::array<std::uint32_t, 3> v = {corner[facet_corners[i][0]], corner[facet_corners[i][1]],
                                      corner[facet_corners[i][2]]};
    if (v[0] > v[1]) std::swap(v[0], v[1]);
    if (v[1] > v[2]) std::swap(v[1], v[2]);
    if (v[0] > v[1]) std::swap(v[0], v[1]);
    return v;
  };
  for (std::size_t t = 0; t < tets; ++t) {
    for (const VertexId v : mesh.corner[TetId(t)])
      if (v.value >= mesh.vertex_count())
        refuse("tet " + text_of(t) + " names vertex " + text_of(v) + " of " + text_of(mesh.vertex_count()));
    for (int i = 0; i < 4; ++i) ++begin[corners_of(t, i)[0] + 1];
  }
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) begin[v + 1] += begin[v];
  std::vector<FacetSide> sides(4 * tets);
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t t = 0; t < tets; ++t)
    for (int i = 0; i < 4; ++i) {
      const auto v = corners_of(t, i);
      sides[next[v[0]]++] = {v[1], v[2], static_cast<std::uint32_t>(4 * t + i)};
    }

  // Buckets share no facet, so they may be worked on side by side.
  parallel_for(mesh.vertex_count(), 4096, [&](std::size_t v) {
    const auto first = sides.begin() + begin[v], last = sides.begin() + begin[v + 1];
    std::sort(first, last, [](const FacetSide& a, const FacetSide& b) {
      return a.middle != b.middle ? a.middle < b.middle : a.high != b.high ? a.high < b.high : a.side < b.side;
    });
    for (auto at = first; at != last;) {
      auto end = at + 1;
      while (end != last && end->middle == at->middle && end->high == at->high) ++end;
      if (end - at > 2)
        refuse("facet (" + text_of(v) + ", " + text_of(at->middle) + ", " + text_of(at->high) + ") belongs to " +
               text_of(end - at) + " tets");
      if (end - at == 2) {
        mesh.neighbor[TetId(at[0].side / 4)][at[0].side % 4] = TetId(at[1].side / 4);
        mesh.neighbor[TetId(at[1].side / 4)][at[1].side % 4] = TetId(at[0].side / 4);
      }
      at = end;
    }
  });
}

// Inward facet normals over three times the volume.
std::array<Vec3d, 4> barycentric_gradients(const TetMesh& mesh, TetId tet) {
  std::array<Vec3d, 4> gradient;
  const auto& c = mesh.corner[tet];
  for (int i = 0; i < 4; ++i) {
    const auto& f = facet_corners[i];
    const Vec3d& a = mesh.position[c[f[0]]];
    const Vec3d inward = (mesh.position[c[f[2]]] - a).cross(mesh.position[c[f[1]]] - a);
    gradient[i] = inward / inward.dot(mesh.position[c[i]] - a);
  }
  return gradient;
}

double signed_volume(const TetMesh& mesh, TetId tet) {
  const auto& corner = mesh.corner[tet];
  const Vec3d& origin = mesh.position[corner[0]];
  const Vec3d a = mesh.position[corner[1]] - origin, b = mesh.position[corner[2]] - origin,
              c = mesh.position[corner[3]] - origin;
  return a.cross(b).dot(c) / 6;
}

Vec3d barycenter(const TetMesh& mesh, TetId tet) {
  const auto& corner = mesh.corner[tet];
  return (mesh.position[corner[0]] + mesh.position[corner[1]] + mesh.position[corner[2]] + mesh.position[corner[3]]) /
         4;
}

Box bounds_of(const TetMesh& mesh) {
  Box box;
  for (const Vec3d& p : mesh.position) box.add(p);
  return box;
}

void validate(const TetMesh& mesh) {
  const std::size_t tets = mesh.tet_count();
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    if (!mesh.position[VertexId(v)].allFinite()) refuse("vertex " + text_of(v) + " is not finite");
  if (mesh.neighbor.size() != tets)
    refuse(text_of(mesh.neighbor.size()) + " rows of neighbours for " + text_of(tets) + " tets");
  if (mesh.region.size() != tets)
    refuse(text_of(mesh.region.size()) + " region numbers for " + text_of(tets) + " tets");
  for (const TetId t : all_ids<TetId>(tets))
    for (const VertexId v : mesh.corner[t])
      if (v.value >= mesh.vertex_count())
        refuse("tet " + text_of(t) + " names vertex " + text_of(v) + " of " + text_of(mesh.vertex_count()));

  const auto same_facet = [&](TetId t, int i, TetId n) {
    for (const int c : facet_corners[i]) {
      const auto& other = mesh.corner[n];
      if (std::find(other.begin(), other.end(), mesh.corner[t][c]) == other.end()) return false;
    }
    return true;
  };
  for (const TetId t : all_ids<TetId>(tets)) {
    if (const double volume = signed_volume(mesh, t); !(volume > 0))
      refuse("tet " + text_of(t) + " has volume " + std::to_string(volume));
    for (int i = 0; i < 4; ++i) {
      const TetId n = mesh.neighbor[t][i];
      if (!n.exists()) continue;
      if (n.value >= tets) refuse("tet " + text_of(t) + " names neighbour " + text_of(n) + " of " + text_of(tets));
      const auto& back = mesh.neighbor[n];
      if (n == t || std::count(back.begin(), back.end(), t) == 0 || !same_facet(t, i, n))
        refuse("tets " + text_of(t) + " and " + text_of(n) + " are not neighbours of each other");
    }
  }
}

VertexTets tets_around_vertices(const TetMesh& mesh) {
  VertexTets rows;
  rows.begin.assign(mesh.vertex_count() + 1, 0);
  for (const auto& corner : mesh.corner)
    for (const VertexId v : corner) ++rows.begin[v + 1];
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) rows.begin[v + 1] += rows.begin[v];
  rows.tet.resize(4 * mesh.tet_count());
  std::vector<std::uint32_t> next(rows.begin.begin(), rows.begin.end() - 1);
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    for (const VertexId v : mesh.corner[t]) rows.tet[next[v]++] = t;
  return rows;
}

VertexNeighbors vertices_around_vertices(const TetMesh& mesh) {
  constexpr std::size_t block = 4096;
  const VertexTets around = tets_around_vertices(mesh);
  const std::size_t count = mesh.vertex_count();
  VertexNeighbors rows;
  rows.begin.assign(count + 1, 0); // at first the length of the row before
  std::vector<std::vector<VertexId>> part((count + block - 1) / block);
  parallel_blocks(count, block, [&](std::size_t begin, std::size_t end) {
    std::vector<VertexId> found;
    std::vector<VertexId>& all = part[begin / block];
    all.reserve((end - begin) * 14);
    for (std::size_t v = begin; v < end; ++v) {
      found.clear();
      for (const TetId t : around[VertexId(v)])
        for (const VertexId other : mesh.corner[t])
          if (other != v) found.push_back(other);
      std::sort(found.begin(), found.end());
      found.erase(std::unique(found.begin(), found.end()), found.end());
      all.insert(all.end(), found.begin(), found.end());
      rows.begin[v + 1] = static_cast<std::uint32_t>(found.size());
    }
  });
  for (std::size_t v = 0; v < count; ++v) rows.begin[v + 1] += rows.begin[v];
  rows.vertex.reserve(rows.begin.back());
  for (const std::vector<VertexId>& one : part) rows.vertex.insert(rows.vertex.end(), one.begin(), one.end());
  return rows;
}

} // namespace pith
