// Cuts: groups of pieces that stand together, their values, and the change made at once. Takayama 2008, §5.1.1, with
// labels in place of copies (docs/design.md, idea 4).
#include "volume/cut/cut.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/cut/clusters.h"
#include "volume/cut/subdivide.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <string>

namespace pith {
namespace {

constexpr double smallest_snap = 1e-6, largest_snap = 0.4;
constexpr double largest_flat_snap = 0.01, flatness = 1e-6; ///< of the solid's diagonal, of a plane's section

void check(const Pieces& pieces, const TetMesh& root, const Boundary& boundary, const CutOptions& options) {
  if (pieces.root_vertex_count != root.vertex_count() || pieces.label.size() != root.tet_count() ||
      boundary.facet_of_tet.size() != root.tet_count())
    throw InvalidInput("cut",
                       "the pieces and the boundary do not belong to this mesh of " +
                           std::to_string(root.tet_count()) + " tets",
                       "pass the mesh that they were made from");
  for (const std::uint32_t p : options.only)
    if (p >= pieces.piece.size())
      throw InvalidInput("cut",
                         "there is no piece " + std::to_string(p) + " among " + std::to_string(pieces.piece.size()),
                         "name pieces that exist");
  if (!(options.snap >= 0 && options.snap <= largest_snap))
    throw InvalidInput("cut", "the snap is " + std::to_string(options.snap) + " of an edge", "give 0 to 0.4");
}

bool same(const Rigid& a, const Rigid& b) { return a.rotation == b.rotation && a.translation == b.translation; }

constexpr std::uint32_t no_group = 0xffffffffu;

/// The pieces to cut, by placement, in the order of their first piece.
struct Groups {
  std::vector<PieceGroup> group;
  std::vector<std::uint32_t> of_piece; ///< no_group: not cut
};

Groups groups_of(const Pieces& pieces, const std::vector<std::uint32_t>& only) {
  std::vector<bool> wanted(pieces.piece.size(), only.empty());
  for (const std::uint32_t p : only) wanted[p] = true;
  Groups groups;
  groups.of_piece.assign(pieces.piece.size(), no_group);
  for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) {
    if (!wanted[p]) continue;
    const auto at = std::find_if(groups.group.begin(), groups.group.end(), [&](const PieceGroup& group) {
      return same(group.placement, pieces.piece[p].placement);
    });
    groups.of_piece[p] = static_cast<std::uint32_t>(at - groups.group.begin());
    if (at == groups.group.end()) {
      groups.group.emplace_back();
      groups.group.back().placement = pieces.piece[p].placement;
    }
    groups.group[groups.of_piece[p]].piece.push_back(p);
  }
  return groups;
}

/// All whole tets of the groups are to be looked at.
void take_all_tets(Groups& groups, const Pieces& pieces) {
  if (groups.group.size() == 1 && groups.group[0].piece.size() == pieces.piece.size()) {
    groups.group[0].everything = true;
    return;
  }
  for (const TetId t : all_ids<TetId>(pieces.label.size()))
    if (const std::uint32_t p = pieces.label[t]; p != Pieces::was_cut && groups.of_piece[p] != no_group)
      groups.group[groups.of_piece[p]].whole.push_back(t);
}

/// The whole tets of group g in clusters that the level set may reach, ascending; of the others the side.
void take_near_tets(Groups& groups, std::uint32_t g, const Pieces& pieces, const TetClusters& clusters,
                    const LevelSet& level_set) {
  PieceGroup& group = groups.group[g];
  group.clusters = &clusters;
  group.cluster_side = sides_of_clusters(clusters, level_set, group.placement);
  group.seen_far.assign(pieces.piece.size(), 0);
  constexpr std::size_t block = 32768, run = 64;
  struct Found {
    std::vector<TetId> near, above;
    std::vector<std::uint8_t> seen;
  };
  std::vector<Found> found((pieces.label.size() + block - 1) / block);
  parallel_blocks(pieces.label.size(), block, [&](std::size_t begin, std::size_t end) {
    Found& here = found[begin / block];
    here.seen.assign(pieces.piece.size(), 0);
    const auto look = [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        const TetId t(i);
        const std::uint32_t p = pieces.label[t];
        if (p == Pieces::was_cut || groups.of_piece[p] != g) continue;
        const int side = group.cluster_side[clusters.cluster[t]];
        if (side == 0)
          here.near.push_back(t);
        else
          here.seen[p] |= side < 0 ? side_below : side_above;
        if (side > 0) here.above.push_back(t);
      }
    };
    if (group.piece.size() > 1) return look(begin, end);
    const std::uint32_t only = group.piece[0]; // most runs of tets have none of a small piece
    std::size_t from = begin;
    for (; from + run <= end; from += run) {
      const std::uint32_t* label = &pieces.label[TetId(from)];
      std::uint32_t hits = 0;
      for (std::size_t i = 0; i < run; ++i) hits += label[i] == only;
      if (hits > 0) look(from, from + run);
    }
    look(from, end);
  });
  for (const Found& part : found) {
    group.whole.insert(group.whole.end(), part.near.begin(), part.near.end());
    group.far_above.insert(group.far_above.end(), part.above.begin(), part.above.end());
    for (const std::uint32_t p : group.piece) group.seen_far[p] |= part.seen.empty() ? 0 : part.seen[p];
  }
}

/// The vertices of all tets that are looked at; empty: all vertices of the pieces are.
std::vector<VertexId> vertices_of(const Pieces& pieces, const TetMesh& root, const PieceGroup& group,
                                  std::vector<std::uint8_t>& used) {
  std::vector<VertexId> vertex;
  if (group.everything) return vertex;
  used.assign(pieces.root_vertex_count + pieces.added.size(), 0);
  const auto use = [&](const std::array<VertexId, 4>& corner) {
    for (const VertexId v : corner)
      if (!used[v]) {
        used[v] = 1;
        vertex.push_back(v);
      }
  };
  for (const TetId t : group.whole) use(root.corner[t]);
  for (const std::uint32_t p : group.piece)
    for (const CutTet& tet : pieces.piece[p].cut)
      if (group.far_side(tet.root) == 0) use(tet.corner);
  return vertex;
}

/// φ(placement · x) at the vertices that the group looks at; elsewhere anything.
void evaluate(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, std::span<const VertexId> vertex,
              const LevelSet& level_set, std::vector<double>& value) {
  value.resize(pieces.root_vertex_count + pieces.added.size());
  if (group.everything && group.placement.identity()) {
    level_set.values(root.position, std::span(value).first(root.vertex_count()));
    level_set.values(pieces.added_position, std::span(value).subspan(root.vertex_count()));
    return;
  }
  const std::size_t count = group.everything ? value.size() : vertex.size();
  const auto at = [&](std::size_t i) { return group.everything ? VertexId(i) : vertex[i]; };
  std::vector<Vec3d> place(count);
  parallel_for(count, 16384, [&](std::size_t i) { place[i] = group.placement(pieces.position(root, at(i))); });
  std::vector<double> there(count);
  level_set.values(place, there);
  for (std::size_t i = 0; i < count; ++i) value[at(i)] = there[i];
}

/// As reserve, but many small steps cost no more than one large.
template <class T>
void reserve_ahead(std::vector<T>& values, std::size_t count) {
  if (count > values.capacity()) values.reserve(std::max(count, values.size() + values.size() / 2));
}

/// Puts the cuts of all groups into the pieces. All memory is taken first, so that nothing changes if it runs out.
CutResult commit(Pieces& pieces, const Groups& groups, const std::vector<Sides>& sides, std::vector<GroupCut>& cuts) {
  CutResult result;
  std::size_t added = pieces.added.size(), on_section = pieces.on_section.size();
  std::vector<std::uint32_t> right_of(pieces.piece.size(), Pieces::was_cut);
  for (std::size_t p = 0; p < pieces.piece.size(); ++p) result.origin.push_back({static_cast<std::uint32_t>(p), 0});
  std::vector<std::pair<std::uint32_t, GroupCut*>> halved; // piece, and its group's cut
  for (GroupCut& cut : cuts) {
    added += cut.added.size();
    on_section += cut.on_section.size();
    result.tets_cut += cut.tets_cut;
    for (const std::uint32_t p : cut.piece) halved.emplace_back(p, &cut);
  }
  std::sort(halved.begin(), halved.end());
  for (const auto& [p, cut] : halved) {
    right_of[p] = static_cast<std::uint32_t>(result.origin.size());
    result.origin[p].side = -1;
    result.origin.push_back({p, 1});
  }
  std::vector<SectionNormal> normals; // of this cut: one for each vertex, the first group's
  for (const GroupCut& cut : cuts) normals.insert(normals.end(), cut.on_section.begin(), cut.on_section.end());
  std::stable_sort(normals.begin(), normals.end(),
                   [](const SectionNormal& a, const SectionNormal& b) { return a.vertex < b.vertex; });
  normals.erase(std::unique(normals.begin(), normals.end(),
                            [](const SectionNormal& a, const SectionNormal& b) { return a.vertex == b.vertex; }),
                normals.end());
  reserve_ahead(pieces.added, added);
  reserve_ahead(pieces.added_position, added);
  reserve_ahead(pieces.added_normal, added);
  reserve_ahead(pieces.on_section, on_section);
  pieces.piece.reserve(result.origin.size());

  constexpr std::size_t block = 65536;
  for (std::size_t g = 0; g < groups.group.size(); ++g) {
    const PieceGroup& group = groups.group[g];
    const auto to_right = [&](TetId t) {
      std::uint32_t& label = pieces.label[t];
      if (label < right_of.size() && groups.of_piece[label] == g && right_of[label] != Pieces::was_cut)
        label = right_of[label];
    };
    parallel_for(sides[g].whole.size(), block, [&](std::size_t i) {
      if (sides[g].whole[i] == side_above) to_right(group.everything ? TetId(i) : group.whole[i]);
    });
    parallel_for(group.far_above.size(), block, [&](std::size_t i) { to_right(group.far_above[i]); });
    for (const TetId t : cuts[g].opened) pieces.label[t] = Pieces::was_cut;
    pieces.added.insert(pieces.added.end(), cuts[g].added.begin(), cuts[g].added.end());
    pieces.added_position.insert(pieces.added_position.end(), cuts[g].added_position.begin(),
                                 cuts[g].added_position.end());
    pieces.added_normal.insert(pieces.added_normal.end(), cuts[g].added_normal.begin(), cuts[g].added_normal.end());
  }
  pieces.on_section.insert(pieces.on_section.end(), normals.begin(), normals.end());
  for (const auto& [p, cut] : halved) {
    const std::size_t row = std::lower_bound(cut->piece.begin(), cut->piece.end(), p) - cut->piece.begin();
    pieces.piece[p].cut = std::move(cut->below[row]);
    pieces.piece.push_back({std::move(cut->above[row]), pieces.piece[p].placement});
  }
  ++pieces.cut_count;
  return result;
}

} // namespace

struct Cutter::Parts {
  const TetMesh& root;
  const Boundary& boundary;
  std::optional<TetClusters> clusters = {}; ///< none: every tet is looked at
  double diagonal = bounds_of(root).diagonal();
  std::vector<double> value = {}; ///< memory that is used again, as below
  std::vector<std::uint8_t> used = {}, state = {};

  /// `values` in place of the level set's where there are any.
  CutResult cut(Pieces& pieces, std::optional<std::span<const double>> values, const LevelSet* level_set,
                const CutOptions& options) {
    check(pieces, root, boundary, options);
    Groups groups = groups_of(pieces, options.only);
    const bool near_only = clusters && !values;
    if (!near_only) take_all_tets(groups, pieces);
    const std::size_t count = groups.group.size();
    std::vector<Sides> sides(count);
    std::vector<GroupCut> cuts(count);
    std::size_t next = pieces.root_vertex_count + pieces.added.size();
    bool any = false;
    for (std::uint32_t g = 0; g < count; ++g) {
      if (near_only) take_near_tets(groups, g, pieces, *clusters, *level_set);
      const PieceGroup& group = groups.group[g];
      const std::vector<VertexId> vertex = vertices_of(pieces, root, group, used);
      if (!values) evaluate(pieces, root, group, vertex, *level_set, value);
      GroupField field{values ? *values : std::span<const double>(value), vertex, level_set,
                       std::max(options.snap, smallest_snap), std::numeric_limits<double>::infinity()};
      if (level_set && level_set->linear() && options.snap <= largest_flat_snap)
        field.snap_distance = flatness * diagonal;
      sides[g] = sides_of(pieces, root, group, field, clusters ? &clusters->around : nullptr, std::move(state));
      if (options.manifold) part_pinches(pieces, root, group, field, sides[g]);
      cuts[g] = subdivided(pieces, root, boundary, group, sides[g], field, VertexId(next));
      next += cuts[g].added.size();
      any |= !cuts[g].piece.empty();
      state = std::move(sides[g].state);
    }
    if (!any) refuse_uncut(pieces, values, level_set, options);
    return commit(pieces, groups, sides, cuts);
  }

  [[noreturn]] void refuse_uncut(const Pieces& pieces, std::optional<std::span<const double>> values,
                                 const LevelSet* level_set, const CutOptions& options) {
    Groups groups = groups_of(pieces, options.only);
    take_all_tets(groups, pieces);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const PieceGroup& group : groups.group) {
      if (!values) evaluate(pieces, root, group, vertices_of(pieces, root, group, used), *level_set, value);
      const auto widen = [&](const std::array<VertexId, 4>& corner) {
        for (const VertexId v : corner) {
          low = std::min(low, values ? (*values)[v] : value[v]);
          high = std::max(high, values ? (*values)[v] : value[v]);
        }
      };
      for (const TetId t : all_ids<TetId>(group.everything ? root.tet_count() : group.whole.size())) {
        const TetId whole = group.everything ? t : group.whole[t];
        if (pieces.label[whole] != Pieces::was_cut) widen(root.corner[whole]);
      }
      for (const std::uint32_t p : group.piece)
        for (const CutTet& tet : pieces.piece[p].cut) widen(tet.corner);
    }
    throw InvalidInput("cut",
                       "nothing is cut: the field runs from " + std::to_string(low) + " to " + std::to_string(high) +
                           " over the pieces, all on one side",
                       "move the cut so that it passes through a piece");
  }

  CutResult cut_by_values(Pieces& pieces, std::span<const double> values, const LevelSet* level_set,
                          const CutOptions& options) {
    const std::size_t vertices = pieces.root_vertex_count + pieces.added.size();
    if (values.size() != vertices)
      throw InvalidInput("cut",
                         std::to_string(values.size()) + " values for " + std::to_string(vertices) + " vertices",
                         "give one value for every root vertex, then for every added vertex");
    return cut(pieces, values, level_set, options);
  }
};

Cutter::Cutter(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Cutter::Cutter(const TetMesh& root, const Boundary& boundary)
    : Cutter(std::unique_ptr<Parts>(new Parts{root, boundary, clusters_of(root)})) {}
Cutter::~Cutter() = default;
Cutter::Cutter(Cutter&&) noexcept = default;

CutResult Cutter::cut(Pieces& pieces, const LevelSet& level_set, const CutOptions& options) {
  return parts_->cut(pieces, {}, &level_set, options);
}
CutResult Cutter::cut_by_values(Pieces& pieces, std::span<const double> value, const LevelSet* level_set,
                                const CutOptions& options) {
  return parts_->cut_by_values(pieces, value, level_set, options);
}

Cutter Cutter::for_one_cut(const TetMesh& root, const Boundary& boundary) {
  return Cutter(std::unique_ptr<Parts>(new Parts{root, boundary}));
}

CutResult cut(Pieces& pieces, const TetMesh& root, const Boundary& boundary, const LevelSet& level_set,
              const CutOptions& options) {
  return Cutter::for_one_cut(root, boundary).cut(pieces, level_set, options);
}

CutResult cut_by_values(Pieces& pieces, const TetMesh& root, const Boundary& boundary, std::span<const double> value,
                        const LevelSet* level_set, const CutOptions& options) {
  return Cutter::for_one_cut(root, boundary).cut_by_values(pieces, value, level_set, options);
}

} // namespace pith
