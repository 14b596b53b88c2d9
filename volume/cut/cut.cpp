// Cuts: groups of pieces that stand together, their values, and the change made at once. Takayama 2008, §5.1.1, with
// labels in place of copies (docs/design.md, idea 4).
#include "volume/cut/cut.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/cut/subdivide.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

namespace pith {
namespace {

constexpr double smallest_snap = 1e-6, largest_snap = 0.4;

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

/// The pieces to cut, by placement, in the order of their first piece.
std::vector<PieceGroup> groups_of(const Pieces& pieces, const std::vector<std::uint32_t>& only) {
  std::vector<bool> wanted(pieces.piece.size(), only.empty());
  for (const std::uint32_t p : only) wanted[p] = true;
  std::vector<PieceGroup> groups;
  std::vector<std::uint32_t> group_of(pieces.piece.size(), 0xffffffffu);
  for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) {
    if (!wanted[p]) continue;
    const auto at = std::find_if(groups.begin(), groups.end(), [&](const PieceGroup& group) {
      return same(group.placement, pieces.piece[p].placement);
    });
    group_of[p] = static_cast<std::uint32_t>(at - groups.begin());
    if (at == groups.end()) groups.push_back({pieces.piece[p].placement, {}, {}, false});
    groups[group_of[p]].piece.push_back(p);
  }
  if (groups.size() == 1 && groups[0].piece.size() == pieces.piece.size()) {
    groups[0].everything = true;
    return groups;
  }
  for (const TetId t : all_ids<TetId>(pieces.label.size()))
    if (const std::uint32_t p = pieces.label[t]; p != Pieces::was_cut && group_of[p] != 0xffffffffu)
      groups[group_of[p]].whole.push_back(t);
  return groups;
}

/// φ(placement · x) at the vertices of a group's pieces; elsewhere what was there (0 at first).
void evaluate(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, const LevelSet& level_set,
              std::vector<double>& value) {
  const std::size_t vertices = pieces.root_vertex_count + pieces.added.size();
  value.resize(vertices, 0.0);
  if (group.everything && group.placement.identity()) {
    level_set.values(root.position, std::span(value).first(root.vertex_count()));
    level_set.values(pieces.added_position, std::span(value).subspan(root.vertex_count()));
    return;
  }
  std::vector<bool> used(vertices, group.everything);
  for (const TetId t : group.whole)
    for (const VertexId v : root.corner[t]) used[v] = true;
  for (const std::uint32_t p : group.piece)
    for (const CutTet& tet : pieces.piece[p].cut)
      for (const VertexId v : tet.corner) used[v] = true;
  std::vector<VertexId> vertex;
  std::vector<Vec3d> place;
  for (std::size_t v = 0; v < vertices; ++v)
    if (used[v]) {
      vertex.push_back(VertexId(v));
      place.push_back(group.placement(pieces.position(root, VertexId(v))));
    }
  std::vector<double> there(place.size());
  level_set.values(place, there);
  for (std::size_t i = 0; i < vertex.size(); ++i) value[vertex[i]] = there[i];
}

[[noreturn]] void refuse_uncut(double low, double high) {
  throw InvalidInput("cut",
                     "nothing is cut: the field runs from " + std::to_string(low) + " to " + std::to_string(high) +
                         " over the pieces, all on one side",
                     "move the cut so that it passes through a piece");
}

/// Puts the cuts of all groups into the pieces. All memory is taken first, so that nothing changes if it runs out.
CutResult commit(Pieces& pieces, const std::vector<PieceGroup>& groups, const std::vector<Sides>& sides,
                 std::vector<GroupCut>& cuts) {
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
  pieces.added.reserve(added);
  pieces.added_position.reserve(added);
  pieces.added_normal.reserve(added);
  pieces.on_section.reserve(on_section);
  pieces.piece.reserve(result.origin.size());

  constexpr std::size_t block = 65536;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const PieceGroup& group = groups[g];
    parallel_for(sides[g].whole.size(), block, [&](std::size_t i) {
      if (sides[g].whole[i] != side_above) return;
      std::uint32_t& label = pieces.label[group.everything ? TetId(i) : group.whole[i]];
      if (right_of[label] != Pieces::was_cut) label = right_of[label];
    });
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

/// Cuts all groups; values_of(group) gives a group's values.
template <class Values>
CutResult cut_groups(Pieces& pieces, const TetMesh& root, const Boundary& boundary, const LevelSet* level_set,
                     const CutOptions& options, const Values& values_of) {
  check(pieces, root, boundary, options);
  const double snap = std::max(options.snap, smallest_snap);
  const std::vector<PieceGroup> groups = groups_of(pieces, options.only);
  std::vector<Sides> sides(groups.size());
  std::vector<GroupCut> cuts(groups.size());
  std::size_t next = pieces.root_vertex_count + pieces.added.size();
  bool any = false;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::span<const double> value = values_of(groups[g]);
    sides[g] = sides_of(pieces, root, groups[g], value, snap);
    cuts[g] = subdivided(pieces, root, boundary, groups[g], sides[g], {value, level_set, snap}, VertexId(next));
    next += cuts[g].added.size();
    any |= !cuts[g].piece.empty();
    sides[g].state = {};
  }
  if (!any) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const PieceGroup& group : groups) {
      const std::span<const double> value = values_of(group);
      const auto widen = [&](const std::array<VertexId, 4>& corner) {
        for (const VertexId v : corner) {
          low = std::min(low, value[v]);
          high = std::max(high, value[v]);
        }
      };
      for (const TetId t : all_ids<TetId>(group.everything ? root.tet_count() : group.whole.size()))
        widen(root.corner[group.everything ? t : group.whole[t]]);
      for (const std::uint32_t p : group.piece)
        for (const CutTet& tet : pieces.piece[p].cut) widen(tet.corner);
    }
    refuse_uncut(low, high);
  }
  return commit(pieces, groups, sides, cuts);
}

} // namespace

CutResult cut(Pieces& pieces, const TetMesh& root, const Boundary& boundary, const LevelSet& level_set,
              const CutOptions& options) {
  std::vector<double> value;
  return cut_groups(pieces, root, boundary, &level_set, options, [&](const PieceGroup& group) {
    evaluate(pieces, root, group, level_set, value);
    return std::span<const double>(value);
  });
}

CutResult cut_by_values(Pieces& pieces, const TetMesh& root, const Boundary& boundary, std::span<const double> value,
                        const LevelSet* level_set, const CutOptions& options) {
  if (value.size() != pieces.root_vertex_count + pieces.added.size())
    throw InvalidInput("cut",
                       std::to_string(value.size()) + " values for " +
                           std::to_string(pieces.root_vertex_count + pieces.added.size()) + " vertices",
                       "give one value for every root vertex, then for every added vertex");
  return cut_groups(pieces, root, boundary, level_set, options, [&](const PieceGroup&) { return value; });
}

void spread(Pieces& pieces, const CutResult& result, const TetMesh& root, double distance) {
  if (!std::isfinite(distance)) throw InvalidInput("spread", "the distance is not finite", "give millimetres");
  if (result.origin.size() != pieces.piece.size())
    throw InvalidInput("spread",
                       "the cut's result has " + std::to_string(result.origin.size()) + " pieces of " +
                           std::to_string(pieces.piece.size()),
                       "spread right after the cut");
  // The sections of right halves look to the left.
  Vec3d normal = Vec3d::Zero();
  double area = 0;
  const FaceTag tag = FaceTag::section(CutId(pieces.cut_count - 1));
  for (std::size_t p = 0; p < pieces.piece.size(); ++p) {
    if (result.origin[p].side <= 0) continue;
    for (const CutTet& tet : pieces.piece[p].cut)
      for (int i = 0; i < 4; ++i) {
        if (tet.face[i] != tag) continue;
        const auto& c = facet_corners[i];
        const Vec3d& at = pieces.position(root, tet.corner[c[0]]);
        const Vec3d facet =
            (pieces.position(root, tet.corner[c[1]]) - at).cross(pieces.position(root, tet.corner[c[2]]) - at);
        normal -= pieces.piece[p].placement.rotation * facet;
        area += facet.norm();
      }
  }
  if (!(normal.norm() > 1e-6 * area))
    throw InvalidInput("spread", "the section has no mean normal: it is closed, or nothing was cut",
                       "move the pieces one by one");
  const Vec3d step = 0.5 * distance * normal.normalized();
  for (std::size_t p = 0; p < pieces.piece.size(); ++p)
    pieces.piece[p].placement.translation += result.origin[p].side * step;
}

} // namespace pith
