// Welding, degenerate and duplicate triangles, orientation.
#include "volume/mesh/tetrahedralize_repair.h"

#include "volume/mesh/surface_defects_intersections.h"
#include "volume/mesh/tetrahedralize_shells.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace pith::surface {
namespace {

using Corners = std::array<VertexId, 3>;

Corners sorted_corners(Corners c) {
  std::sort(c.begin(), c.end());
  return c;
}

/// Keeps the triangles that are marked. Returns how many went.
std::size_t keep_only(Repaired& surface, const PerTriangle<char>& keep) {
  TriangleId next(0u);
  for (const TriangleId t : all_ids<TriangleId>(surface.mesh.triangle_count())) {
    if (!keep[t]) continue;
    surface.mesh.corner[next] = surface.mesh.corner[t];
    surface.source[next] = surface.source[t];
    next = TriangleId(next + 1);
  }
  const std::size_t gone = surface.mesh.triangle_count() - next;
  surface.mesh.corner.resize(next);
  surface.source.resize(next);
  return gone;
}

/// Drops the later ones of triangles with the same corners; a pair of opposite ones encloses nothing, so one of them
/// goes too.
std::size_t drop_duplicates(Repaired& surface) {
  std::vector<std::pair<Corners, TriangleId>> order;
  for (const TriangleId t : all_ids<TriangleId>(surface.mesh.triangle_count()))
    order.emplace_back(sorted_corners(surface.mesh.corner[t]), t);
  std::sort(order.begin(), order.end());
  PerTriangle<char> keep(surface.mesh.triangle_count(), 1);
  for (std::size_t i = 1; i < order.size(); ++i)
    if (order[i].first == order[i - 1].first) keep[order[i].second] = 0;
  return keep_only(surface, keep);
}

/// A triangle a, b, c whose corner c lies on its edge a b covers no area, but dropping it would leave its neighbour d
/// b a with c on its edge. Flipping the edge a b to c d makes two triangles of the neighbour's own area instead.
/// Chains of such triangles take several rounds; what cannot be flipped stays and counts as a defect.
std::size_t flip_collinear(Repaired& surface) {
  std::size_t flipped = 0;
  for (int round = 0; round < 16; ++round) {
    const PerTriangle<char> collinear = collinear_triangles(surface.mesh);
    if (std::count(collinear.begin(), collinear.end(), 0) == std::ptrdiff_t(collinear.size())) break;
    const std::vector<EdgeSide> sides = edge_sides(surface.mesh);
    PerTriangle<char> touched(surface.mesh.triangle_count(), 0);
    std::size_t now = 0;
    const auto edge_exists = [&](std::uint32_t a, std::uint32_t b) {
      const auto key = std::pair(std::min(a, b), std::max(a, b));
      const auto at = std::lower_bound(sides.begin(), sides.end(), key, [](const EdgeSide& side, const auto& wanted) {
        return std::pair(side.low, side.high) < wanted;
      });
      return at != sides.end() && std::pair(at->low, at->high) == key;
    };
    for_each_edge(sides, [&](const EdgeSide* first, const EdgeSide* last) {
      if (last - first != 2) return;
      for (int which = 0; which < 2; ++which) {
        const EdgeSide &side = first[which], &other = first[1 - which];
        const TriangleId flat(side.corner / 3), beyond(other.corner / 3);
        if (!collinear[flat] || collinear[beyond] || touched[flat] || touched[beyond]) continue;
        const int k = static_cast<int>(side.corner % 3), j = static_cast<int>(other.corner % 3);
        const Corners f = surface.mesh.corner[flat], n = surface.mesh.corner[beyond];
        const VertexId a = f[k], b = f[(k + 1) % 3], c = f[(k + 2) % 3], d = n[(j + 2) % 3];
        const auto& p = surface.mesh.position;
        const double along = (p[c] - p[a]).dot(p[b] - p[a]), length = (p[b] - p[a]).squaredNorm();
        if (!(along > 0 && along < length) || side.forward == other.forward || edge_exists(c, d)) continue;
        surface.mesh.corner[flat] = {a, d, c}; // the neighbour runs b, a, d
        surface.mesh.corner[beyond] = {d, b, c};
        surface.source[flat] = surface.source[beyond];
        touched[flat] = touched[beyond] = 1;
        ++now;
        break;
      }
    });
    if (now == 0) break;
    flipped += now;
  }
  return flipped;
}

/// Makes the two triangles of every edge run through it in opposite directions, shell by shell, where every edge of
/// the shell has two triangles. Returns how many shells were scrambled and came out facing outwards.
std::size_t orient(TriMesh& mesh) {
  const std::vector<EdgeSide> sides = edge_sides(mesh);
  DisjointSets sets(mesh.triangle_count());
  std::vector<std::array<std::uint32_t, 3>> across(mesh.triangle_count(), {~0u, ~0u, ~0u});
  std::vector<std::array<bool, 3>> agrees(mesh.triangle_count());
  std::vector<char> open(mesh.triangle_count(), 0),
      scrambled(mesh.triangle_count(), 0); // by representative, once joined
  for_each_edge(sides, [&](const EdgeSide* first, const EdgeSide* last) {
    for (const EdgeSide* side = first + 1; side < last; ++side) sets.join(first->corner / 3, side->corner / 3);
  });
  for_each_edge(sides, [&](const EdgeSide* first, const EdgeSide* last) {
    const std::uint32_t shell = sets.representative(first->corner / 3);
    if (last - first != 2) {
      open[shell] = 1;
      return;
    }
    const bool agree = first[0].forward != first[1].forward;
    if (!agree) scrambled[shell] = 1;
    for (int i = 0; i < 2; ++i) {
      across[first[i].corner / 3][first[i].corner % 3] = first[1 - i].corner / 3;
      agrees[first[i].corner / 3][first[i].corner % 3] = agree;
    }
  });

  std::size_t mended = 0;
  std::vector<char> flip(mesh.triangle_count(), 2); // 2: not reached
  std::vector<std::uint32_t> reached;
  for (std::uint32_t start = 0; start < mesh.triangle_count(); ++start) {
    if (sets.representative(start) != start || open[start] || !scrambled[start]) continue;
    reached = {start};
    flip[start] = 0;
    bool orientable = true;
    for (std::size_t at = 0; at < reached.size(); ++at) {
      const std::uint32_t t = reached[at];
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t n = across[t][k];
        if (n == ~0u) continue;
        const char wanted = agrees[t][k] ? flip[t] : static_cast<char>(1 - flip[t]);
        if (flip[n] == 2) {
          flip[n] = wanted;
          reached.push_back(n);
        } else if (flip[n] != wanted) {
          orientable = false;
        }
      }
    }
    if (!orientable) continue;
    double volume = 0;
    const Vec3d origin = mesh.position[mesh.corner[TriangleId(start)][0]];
    for (const std::uint32_t t : reached) {
      auto& corner = mesh.corner[TriangleId(t)];
      if (flip[t]) std::swap(corner[1], corner[2]);
      volume += (mesh.position[corner[0]] - origin)
                    .cross(mesh.position[corner[1]] - origin)
                    .dot(mesh.position[corner[2]] - origin);
    }
    if (volume < 0)
      for (const std::uint32_t t : reached) std::swap(mesh.corner[TriangleId(t)][1], mesh.corner[TriangleId(t)][2]);
    ++mended;
  }
  return mended;
}

void add_note(std::string& note, std::size_t count, const char* one, const char* many) {
  if (count == 0) return;
  if (!note.empty()) note += ", ";
  note += std::to_string(count) + " " + (count == 1 ? one : many);
}

} // namespace

void mend(Repaired& surface) {
  const std::size_t duplicates = drop_duplicates(surface);
  const std::size_t flipped = flip_collinear(surface);
  const std::size_t scrambled = orient(surface.mesh);
  add_note(surface.note, duplicates, "duplicate triangle dropped", "duplicate triangles dropped");
  add_note(surface.note, flipped, "triangle of no area replaced", "triangles of no area replaced");
  add_note(surface.note, scrambled, "shell oriented", "shells oriented");
}

bool can_be_filled(SurfaceDefects defects) {
  defects.inside_out_shells = 0;
  defects.volume = 1; // closed and free of self-intersections, each shell has one, whatever its sign
  return defects.clean();
}

void drop_unused_vertices(TriMesh& mesh) {
  PerVertex<VertexId> number(mesh.vertex_count());
  for (const auto& corner : mesh.corner)
    for (const VertexId v : corner) number[v] = VertexId(0u);
  VertexId next(0u);
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count())) {
    if (!number[v].exists()) continue;
    mesh.position[next] = mesh.position[v];
    number[v] = next;
    next = VertexId(next + 1);
  }
  mesh.position.resize(next);
  for (auto& corner : mesh.corner)
    for (VertexId& v : corner) v = number[v];
}

Repaired repaired(const TriMesh& mesh) {
  Repaired result;
  TriMesh numbered = mesh; // `part` carries the triangle's number through the weld
  numbered.part.resize(mesh.triangle_count());
  for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count()))
    numbered.part[t] = static_cast<std::int32_t>(t.value);
  result.mesh = welded(numbered);
  for (const std::int32_t t : result.mesh.part) result.source.push_back(TriangleId(static_cast<std::uint32_t>(t)));
  result.mesh.part.clear();
  add_note(result.note, mesh.triangle_count() - result.mesh.triangle_count(), "collapsed triangle dropped",
           "collapsed triangles dropped");
  mend(result);
  return result;
}

} // namespace pith::surface
