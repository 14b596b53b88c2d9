// Closing holes, and cutting out what is at fault.
// Follows Barequet and Sharir, Filling gaps in the boundary of a polyhedron (CAGD 1995): among all triangulations of
// a border loop the one of least area, by dynamic programming. Edges that the surface already has are left out, as
// they would become non-manifold.
#include "volume/mesh/surface_defects_intersections.h"
#include "volume/mesh/tetrahedralize_repair.h"
#include "volume/mesh/tetrahedralize_shells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>

namespace pith::surface {
namespace {

constexpr std::size_t longest_planned_loop = 500; // its cost grows with the cube of the length
constexpr double most_faulty = 0.2;               // of the triangles; beyond, cutting out would make another object
constexpr int rounds = 6;

using Loop = std::vector<VertexId>;

/// The loops around holes, each running so that a triangle in it runs with it. Where several holes touch in a vertex
/// they come out one by one; chains that do not close are passed over.
std::vector<Loop> border_loops(const std::vector<EdgeSide>& sides) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges; // from, to
  for_each_edge(sides, [&](const EdgeSide* first, const EdgeSide* last) {
    if (last - first != 1) return;
    edges.emplace_back(first->forward ? first->high : first->low, first->forward ? first->low : first->high);
  });
  std::sort(edges.begin(), edges.end());
  std::vector<char> used(edges.size(), 0);
  std::map<std::uint32_t, std::size_t> place; // in the path, by vertex
  std::vector<Loop> loops;
  Loop path;
  for (std::size_t start = 0; start < edges.size(); ++start) {
    if (used[start]) continue;
    path = {VertexId(edges[start].first)};
    place = {{edges[start].first, 0}};
    for (;;) {
      const std::uint32_t at = path.back();
      auto next = std::lower_bound(edges.begin(), edges.end(), std::pair(at, 0u));
      while (next != edges.end() && next->first == at && used[static_cast<std::size_t>(next - edges.begin())]) ++next;
      if (next == edges.end() || next->first != at) break;
      used[static_cast<std::size_t>(next - edges.begin())] = 1;
      const auto seen = place.find(next->second);
      if (seen == place.end()) {
        place[next->second] = path.size();
        path.push_back(VertexId(next->second));
        continue;
      }
      loops.emplace_back(path.begin() + static_cast<std::ptrdiff_t>(seen->second), path.end());
      while (path.size() > seen->second + 1) {
        place.erase(path.back());
        path.pop_back();
      }
    }
  }
  std::erase_if(loops, [](const Loop& loop) { return loop.size() < 3; });
  return loops;
}

class HoleFiller {
public:
  HoleFiller(TriMesh& mesh, const std::vector<EdgeSide>& sides) : mesh_(mesh), sides_(sides) {}

  void fill(const Loop& loop) {
    if (loop.size() > longest_planned_loop || !fill_least_area(loop)) fill_fan(loop);
  }

private:
  bool edge_exists(VertexId a, VertexId b) const {
    const auto key = std::pair<std::uint32_t, std::uint32_t>(std::min(a, b), std::max(a, b));
    const auto at = std::lower_bound(sides_.begin(), sides_.end(), key, [](const EdgeSide& side, const auto& wanted) {
      return std::pair(side.low, side.high) < wanted;
    });
    return at != sides_.end() && std::pair(at->low, at->high) == key;
  }
  double area(VertexId a, VertexId b, VertexId c) const {
    const auto& p = mesh_.position;
    return 0.5 * (p[b] - p[a]).cross(p[c] - p[a]).norm();
  }
  /// cost(i, k): the least area that spans the loop's corners i .. k; middle(i, k): the third corner of the triangle
  /// at i k.
  bool fill_least_area(const Loop& loop) {
    const std::size_t n = loop.size();
    std::vector<double> cost(n * n, 0);
    std::vector<std::uint32_t> middle(n * n, 0);
    for (std::size_t width = 2; width < n; ++width)
      for (std::size_t i = 0; i + width < n; ++i) {
        const std::size_t k = i + width;
        double best = std::numeric_limits<double>::infinity();
        const bool closing = width + 1 == n; // the edge k i is the loop's own
        if (closing || !edge_exists(loop[i], loop[k]))
          for (std::size_t m = i + 1; m < k; ++m) {
            const double now = cost[i * n + m] + cost[m * n + k] + area(loop[i], loop[m], loop[k]);
            if (now < best) {
              best = now;
              middle[i * n + k] = static_cast<std::uint32_t>(m);
            }
          }
        cost[i * n + k] = best;
      }
    if (!(cost[n - 1] < std::numeric_limits<double>::infinity())) return false;
    std::vector<std::pair<std::size_t, std::size_t>> open = {{0, n - 1}};
    while (!open.empty()) {
      const auto [i, k] = open.back();
      open.pop_back();
      if (k - i < 2) continue;
      const std::size_t m = middle[i * n + k];
      mesh_.corner.push_back({loop[i], loop[m], loop[k]});
      open.emplace_back(i, m);
      open.emplace_back(m, k);
    }
    return true;
  }
  void fill_fan(const Loop& loop) {
    Vec3d center = Vec3d::Zero();
    for (const VertexId v : loop) center += mesh_.position[v];
    const VertexId middle(mesh_.vertex_count());
    mesh_.position.push_back(center / static_cast<double>(loop.size()));
    for (std::size_t i = 0; i < loop.size(); ++i)
      mesh_.corner.push_back({loop[i], loop[(i + 1) % loop.size()], middle});
  }

  TriMesh& mesh_;
  const std::vector<EdgeSide>& sides_;
};

/// Marks what keeps the surface from being clean. Returns how many triangles.
std::size_t mark_faults(const TriMesh& mesh, PerTriangle<char>& fault) {
  const PerTriangle<char> collinear = collinear_triangles(mesh);
  fault = intersecting_triangles(mesh, collinear);
  for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count())) fault[t] |= collinear[t];
  const std::vector<EdgeSide> sides = edge_sides(mesh);
  for_each_edge(sides, [&](const EdgeSide* first, const EdgeSide* last) { // borders too: those that form no loop
    if (last - first == 2 && first[0].forward != first[1].forward) return;
    for (const EdgeSide* side = first; side < last; ++side) fault[TriangleId(side->corner / 3)] = 1;
  });
  const PerVertex<char> torn = torn_vertices(mesh, sides);
  for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count()))
    for (const VertexId v : mesh.corner[t]) fault[t] |= torn[v];
  return static_cast<std::size_t>(std::count(fault.begin(), fault.end(), 1));
}

/// Whether shells that matter run through one another (a handle through a wall). Cutting would part them with a gap.
bool large_parts_cross(const TriMesh& mesh) {
  constexpr double matters = 0.01; // of the area
  const std::vector<Shell> shells = shells_of(mesh, edge_sides(mesh));
  std::vector<double> area(shells.size(), 0);
  double whole = 0;
  for (std::size_t s = 0; s < shells.size(); ++s) {
    for (const TriangleId t : shells[s].triangle) {
      const auto& c = mesh.corner[t];
      const auto& p = mesh.position;
      area[s] += 0.5 * (p[c[1]] - p[c[0]]).cross(p[c[2]] - p[c[0]]).norm();
    }
    whole += area[s];
  }
  PerTriangle<std::uint32_t> part(mesh.triangle_count(), 0);
  for (std::size_t s = 0; s < shells.size(); ++s)
    if (area[s] > matters * whole)
      for (const TriangleId t : shells[s].triangle) part[t] = static_cast<std::uint32_t>(s + 1);
  return parts_cross(mesh, collinear_triangles(mesh), part);
}

/// Marks the triangles that share a vertex with a marked one.
void grow(const TriMesh& mesh, PerTriangle<char>& marked) {
  PerVertex<char> near(mesh.vertex_count(), 0);
  for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count()))
    if (marked[t])
      for (const VertexId v : mesh.corner[t]) near[v] = 1;
  for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count()))
    for (const VertexId v : mesh.corner[t]) marked[t] |= near[v];
}

/// Takes marked triangles away, and crumbs that hung on them alone. Returns how many.
std::size_t take_away(Repaired& surface, PerTriangle<char>& marked) {
  constexpr std::size_t crumb = 12; // triangles of an open shell too small to matter
  const auto remove_marked = [&] {
    Repaired kept;
    for (const TriangleId t : all_ids<TriangleId>(surface.mesh.triangle_count())) {
      if (marked[t]) continue;
      kept.mesh.corner.push_back(surface.mesh.corner[t]);
      kept.source.push_back(surface.source[t]);
    }
    const std::size_t gone = surface.mesh.triangle_count() - kept.mesh.triangle_count();
    surface.mesh.corner.swap(kept.mesh.corner);
    surface.source.swap(kept.source);
    return gone;
  };
  std::size_t gone = remove_marked();
  marked.assign(surface.mesh.triangle_count(), 0);
  for (const Shell& shell : shells_of(surface.mesh, edge_sides(surface.mesh)))
    if (!shell.closed && shell.triangle.size() <= crumb)
      for (const TriangleId t : shell.triangle) marked[t] = 1;
  gone += remove_marked();
  return gone;
}

} // namespace

std::size_t close_holes(Repaired& surface, double& widest) {
  const std::vector<EdgeSide> sides = edge_sides(surface.mesh);
  const std::vector<Loop> loops = border_loops(sides);
  HoleFiller filler(surface.mesh, sides);
  for (const Loop& loop : loops) {
    Box box;
    for (const VertexId v : loop) box.add(surface.mesh.position[v]);
    widest = std::max(widest, box.diagonal());
    filler.fill(loop);
  }
  surface.source.resize(surface.mesh.triangle_count());
  return loops.size();
}

std::size_t cut_out_faults(Repaired& surface) {
  if (large_parts_cross(surface.mesh)) return 0;
  Repaired trial = surface;
  std::size_t gone = 0;
  for (int round = 0; round <= rounds; ++round) {
    PerTriangle<char> fault;
    if (mark_faults(trial.mesh, fault) == 0) break;
    if (round == rounds) return 0;
    for (int ring = 0; ring < round; ++ring) grow(trial.mesh, fault);
    gone += take_away(trial, fault);
    if (static_cast<double>(gone) > most_faulty * static_cast<double>(surface.mesh.triangle_count())) return 0;
    double ignored = 0;
    close_holes(trial, ignored);
    mend(trial);
  }
  if (gone == 0 || !can_be_filled(surface_defects(trial.mesh))) return 0;
  trial.note = surface.note;
  surface = std::move(trial);
  return gone;
}

void append_added(Repaired& surface, TriMesh& original) {
  std::map<std::array<double, 3>, VertexId> number;
  bool any = false;
  for (const TriangleId source : surface.source) any = any || !source.exists();
  if (!any) return;
  const auto key = [](const Vec3d& p) { return std::array<double, 3>{p.x(), p.y(), p.z()}; };
  for (const VertexId v : all_ids<VertexId>(original.vertex_count()))
    number.try_emplace(key(original.position[v]), v);
  for (const TriangleId t : all_ids<TriangleId>(surface.mesh.triangle_count())) {
    if (surface.source[t].exists()) continue;
    surface.source[t] = TriangleId(original.triangle_count());
    std::array<VertexId, 3> corner;
    for (int i = 0; i < 3; ++i) {
      const Vec3d& p = surface.mesh.position[surface.mesh.corner[t][i]];
      const auto [at, fresh] = number.try_emplace(key(p), VertexId(original.vertex_count()));
      if (fresh) original.position.push_back(p);
      corner[i] = at->second;
    }
    original.corner.push_back(corner);
    if (!original.part.empty()) original.part.push_back(0);
  }
}

} // namespace pith::surface
