// From shells to regions. Tets are flooded from facet to facet, stopping at the surface's triangles; the deepest
// shell that a flood lies inside of gives its region. No point inside a region has to be found, and the flood checks
// on its way that TetGen kept every triangle and made tets nowhere else.
#include "volume/mesh/tetrahedralize_regions.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <numeric>

namespace pith::surface {
namespace {

/// The triangles of a surface, found by their three corners.
class TriangleTable {
public:
  explicit TriangleTable(const TriMesh& mesh) : begin_(mesh.vertex_count() + 1, 0), entry_(mesh.triangle_count()) {
    for (const auto& c : mesh.corner) ++begin_[sorted(c)[0] + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count())) {
      const auto c = sorted(mesh.corner[t]);
      entry_[next[c[0]]++] = {c[1], c[2], t};
    }
  }
  TriangleId find(const std::array<VertexId, 3>& corner) const {
    const auto c = sorted(corner);
    if (c[2] + 1 >= begin_.size()) return {}; // a vertex that TetGen added
    for (std::uint32_t at = begin_[c[0]]; at < begin_[c[0] + 1]; ++at)
      if (entry_[at].middle == c[1] && entry_[at].high == c[2]) return entry_[at].triangle;
    return {};
  }

private:
  struct Entry {
    std::uint32_t middle = 0, high = 0;
    TriangleId triangle;
  };
  static std::array<std::uint32_t, 3> sorted(const std::array<VertexId, 3>& corner) {
    std::array<std::uint32_t, 3> c = {corner[0], corner[1], corner[2]};
    std::sort(c.begin(), c.end());
    return c;
  }
  std::vector<std::uint32_t> begin_;
  std::vector<Entry> entry_;
};

/// Whether b is a, turned but not reversed; both have the same corners.
bool same_turn(const std::array<VertexId, 3>& a, const std::array<VertexId, 3>& b) {
  for (int i = 0; i < 3; ++i)
    if (b[i] == a[0]) return b[(i + 1) % 3] == a[1];
  return false;
}

std::array<VertexId, 3> facet_of(const TetMesh& mesh, TetId t, int i) {
  const auto& c = mesh.corner[t];
  return {c[facet_corners[i][0]], c[facet_corners[i][1]], c[facet_corners[i][2]]};
}

/// Drops the tets that are not kept, and the vertices that only they used; vertices keep their order.
void keep_only(TetMesh& mesh, std::vector<TriangleId>& input, const PerTet<char>& keep) {
  PerVertex<VertexId> number(mesh.vertex_count());
  TetId next(0u);
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
    if (!keep[t]) continue;
    mesh.corner[next] = mesh.corner[t];
    mesh.region[next] = mesh.region[t];
    std::copy_n(input.begin() + 4 * std::ptrdiff_t(t), 4, input.begin() + 4 * std::ptrdiff_t(next));
    for (const VertexId v : mesh.corner[t]) number[v] = VertexId(0u);
    next = TetId(next + 1);
  }
  mesh.corner.resize(next);
  mesh.region.resize(next);
  input.resize(4 * std::size_t(next));
  VertexId last(0u);
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count())) {
    if (!number[v].exists()) continue;
    mesh.position[last] = mesh.position[v];
    number[v] = last;
    last = VertexId(last + 1);
  }
  mesh.position.resize(last);
  for (auto& corner : mesh.corner)
    for (VertexId& v : corner) v = number[v];
  connect(mesh);
}

} // namespace

Regions outward_with_regions(TriMesh& mesh, std::size_t& turned) {
  std::vector<Shell> shells = shells_of(mesh, edge_sides(mesh));
  Regions regions;
  regions.shell.assign(mesh.triangle_count(), 0);
  std::vector<std::uint32_t> order(shells.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return shells[a].depth < shells[b].depth; });
  regions.depth.resize(shells.size());
  regions.region.assign(shells.size(), -1);
  std::int32_t next = 0;
  turned = 0;
  for (const std::uint32_t s : order) {
    const Shell& shell = shells[s];
    regions.depth[s] = shell.depth;
    const bool in_material = shell.parent && regions.region[*shell.parent] >= 0;
    const bool cavity = in_material && (shell.volume < 0) != (shells[*shell.parent].volume < 0);
    if (!cavity) regions.region[s] = next++;
    if (!shell.parent && shell.volume < 0) ++turned;
    for (const TriangleId t : shell.triangle) regions.shell[t] = s;
  }
  for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count()))
    if (shells[regions.shell[t]].volume < 0) std::swap(mesh.corner[t][1], mesh.corner[t][2]);
  return regions;
}

std::string label_tets(const TriMesh& surface, const Regions& regions, TetMesh& mesh,
                       std::vector<TriangleId>& input) {
  PerTet<char> flat(mesh.tet_count(), 0);
  parallel_for(mesh.tet_count(), 16384, [&](std::size_t i) {
    const TetId t(i);
    const double volume = signed_volume(mesh, t);
    if (volume < 0) std::swap(mesh.corner[t][2], mesh.corner[t][3]);
    flat[t] = volume == 0 || !(signed_volume(mesh, t) > 0) ? 1 : 0;
  });
  if (const auto count = std::count(flat.begin(), flat.end(), 1); count > 0)
    return std::to_string(count) + " of its tets have no volume";
  connect(mesh);

  // Facets on the surface.
  const TriangleTable table(surface);
  input.assign(4 * mesh.tet_count(), {});
  parallel_for(mesh.tet_count(), 16384, [&](std::size_t t) {
    for (int i = 0; i < 4; ++i) input[4 * t + i] = table.find(facet_of(mesh, TetId(t), i));
  });
  PerTriangle<char> found(surface.triangle_count(), 0);
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    for (int i = 0; i < 4; ++i) {
      const TriangleId triangle = input[4 * std::size_t(t) + i];
      if (triangle.exists())
        found[triangle] = 1;
      else if (!mesh.neighbor[t][i].exists())
        return "its tets end away from the surface";
    }
  if (const auto lost = std::count(found.begin(), found.end(), 0); lost > 0)
    return std::to_string(lost) + " triangles of the surface are missing from its tets";

  // Floods.
  constexpr std::int32_t unseen = -2;
  mesh.region.assign(mesh.tet_count(), unseen);
  PerTet<char> keep(mesh.tet_count(), 1);
  bool all_kept = true;
  std::vector<TetId> flood;
  for (const TetId start : all_ids<TetId>(mesh.tet_count())) {
    if (mesh.region[start] != unseen) continue;
    flood = {start};
    mesh.region[start] = -1;
    std::int64_t deepest = -1; // the deepest shell that the flood is inside of
    for (std::size_t at = 0; at < flood.size(); ++at) {
      const TetId t = flood[at];
      for (int i = 0; i < 4; ++i) {
        const TriangleId triangle = input[4 * std::size_t(t) + i];
        if (triangle.exists()) {
          const std::uint32_t shell = regions.shell[triangle];
          if (same_turn(surface.corner[triangle], facet_of(mesh, t, i)) &&
              (deepest < 0 || regions.depth[shell] > regions.depth[static_cast<std::size_t>(deepest)]))
            deepest = shell;
        } else if (const TetId n = mesh.neighbor[t][i]; mesh.region[n] == unseen) {
          mesh.region[n] = -1;
          flood.push_back(n);
        }
      }
    }
    const std::int32_t region = deepest < 0 ? -1 : regions.region[static_cast<std::size_t>(deepest)];
    for (const TetId t : flood) {
      mesh.region[t] = region;
      keep[t] = region >= 0 ? 1 : 0;
    }
    all_kept = all_kept && region >= 0;
  }
  if (!all_kept) keep_only(mesh, input, keep);
  if (mesh.tet_count() == 0) return "there is no tet of material";
  return {};
}

} // namespace pith::surface
