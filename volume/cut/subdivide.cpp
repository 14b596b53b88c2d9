// Both halves of every piece of a group: marching tetrahedra on three states (patterns.h).
#include "volume/cut/subdivide.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/cut/edge_zero.h"
#include "volume/cut/section_directions.h"
#include "volume/mesh/orientation.h"

#include <algorithm>

namespace pith {
namespace {

constexpr std::size_t tets_per_block = 1024;
/// Edges in a block: evaluating a level set takes longer than waking a thread, interpolating does not.
std::size_t edges_per_block(const GroupField& field) { return field.level_set ? 256 : 8192; }

using Corners = std::array<VertexId, 4>;
using Tags = std::array<FaceTag, 4>;

Tags tags_of(const TetReference& tet, const Pieces& pieces, const Boundary& boundary) {
  if (!tet.whole) return pieces.piece[tet.piece].cut[tet.index].face;
  Tags tags;
  const auto& facets = boundary.facet_of_tet[TetId(tet.index)];
  for (int i = 0; i < 4; ++i) tags[i] = facets[i].exists() ? FaceTag::skin(facets[i]) : FaceTag::interior();
  return tags;
}

/// Inner faces with all corners on the zero set that part two halves: of the tets on both sides.
std::vector<SectionTet> section_tets(const Pieces& pieces, const TetMesh& root, const Boundary& boundary,
                                     const Sides& sides) {
  struct Face {
    std::array<std::uint32_t, 4> key; ///< piece, corners ascending
    std::uint32_t tet;                ///< row of sides.touching
    std::uint8_t opposite;
    bool above;
  };
  std::vector<Face> faces;
  for (std::size_t row = 0; row < sides.touching.size(); ++row) {
    const TetReference& tet = sides.touching[row];
    if (sides.seen[tet.piece] != side_crossed) continue;
    const Corners& corner = tet.corner(pieces, root);
    const bool above = patterns[sides.pattern_code(corner)].has_above;
    const Tags tags = tags_of(tet, pieces, boundary);
    for (int i = 0; i < 4; ++i) {
      if (!tags[i].is_interior()) continue;
      std::array<std::uint32_t, 3> v;
      bool on = true;
      for (int k = 0; k < 3; ++k) {
        v[k] = corner[facet_corners[i][k]];
        on &= sides.state[v[k]] == state_on;
      }
      if (!on) continue;
      std::sort(v.begin(), v.end());
      faces.push_back(
          {{tet.piece, v[0], v[1], v[2]}, static_cast<std::uint32_t>(row), static_cast<std::uint8_t>(i), above});
    }
  }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return std::tie(a.key, a.tet) < std::tie(b.key, b.tet); });

  std::vector<std::pair<std::uint32_t, SectionTet>> found;
  for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
    const Face &a = faces[i], &b = faces[i + 1];
    if (a.key != b.key || a.above == b.above) continue;
    for (const Face* face : {&a, &b})
      found.push_back(
          {face->tet, {sides.touching[face->tet], static_cast<std::uint8_t>(1 << face->opposite), face->above}});
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<SectionTet> result;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (i > 0 && found[i].first == found[i - 1].first)
      result.back().faces |= found[i].second.faces;
    else
      result.push_back(found[i].second);
  }
  return result; // in the order of sides.touching
}

Tags with_section(Tags tags, std::uint8_t faces, CutId cut) {
  for (int i = 0; i < 4; ++i)
    if (faces >> i & 1) tags[i] = FaceTag::section(cut);
  return tags;
}

/// New vertices where rounding left a tet without volume: they are moved towards the middle of their edges, from
/// round to round farther, until every tet is positive.
constexpr std::array<double, 3> pulled_to = {0.1, 0.3, 0.5};

/// One group of pieces while it is being cut, step by step.
class Subdivision {
public:
  Subdivision(const Pieces& pieces, const TetMesh& root, const Boundary& boundary, const PieceGroup& group,
              const Sides& sides, const GroupField& field, VertexId first_added)
      : pieces_(pieces), root_(root), boundary_(boundary), group_(group), sides_(sides), field_(field),
        first_added_(first_added), cut_(pieces.cut_count), crossed_(sides.crossed) {}

  GroupCut run() {
    number_pieces();
    if (result_.piece.empty()) return {};
    section_ = section_tets(pieces_, root_, boundary_, sides_);
    result_.tets_cut = crossed_.size();
    const EdgeNumbers edges = numbered_edges();
    place_vertices(edges);
    take_whole_cut_tets();
    split_crossed();
    pull_until_positive();
    find_directions();
    open_root_tets();
    return std::move(result_);
  }

private:
  const Corners& corner_of(std::size_t i) const { return crossed_[i].corner(pieces_, root_); }
  const Pattern& pattern_of(std::size_t i) const { return patterns[sides_.pattern_code(corner_of(i))]; }
  static const SplitEdges& edges_of(const Pattern& pattern) { return split_edges[static_cast<int>(pattern.split)]; }

  void number_pieces() {
    row_of_piece_.assign(pieces_.piece.size(), 0);
    for (const std::uint32_t p : group_.piece)
      if (sides_.seen[p] == side_crossed) {
        row_of_piece_[p] = static_cast<std::uint32_t>(result_.piece.size());
        result_.piece.push_back(p);
      }
    result_.below.resize(result_.piece.size());
    result_.above.resize(result_.piece.size());
  }

  /// The edges that change sign, in the order of the tets; fills made_, and the older vertices on the section.
  EdgeNumbers numbered_edges() {
    std::size_t most = 0;
    for (std::size_t i = 0; i < crossed_.size(); ++i) most += edges_of(pattern_of(i)).count;
    EdgeNumbers edges(most);
    made_.resize(crossed_.size());
    std::vector<VertexId>& old = vertices_.old;
    for (std::size_t i = 0; i < crossed_.size(); ++i) {
      const Corners& corner = corner_of(i);
      const Pattern& pattern = pattern_of(i);
      const SplitEdges& split = edges_of(pattern);
      for (int e = 0; e < split.count; ++e)
        made_[i][e] = VertexId(first_added_ + edges.number(corner[pattern.corner[split.corner[e][0]]],
                                                           corner[pattern.corner[split.corner[e][1]]]));
      for (int k = 0; k < pattern.on; ++k) old.push_back(corner[pattern.corner[k]]);
    }
    for (const SectionTet& tet : section_) {
      const Corners& corner = tet.tet.corner(pieces_, root_);
      for (int i = 0; i < 4; ++i)
        if (tet.faces >> i & 1)
          for (const int c : facet_corners[i]) old.push_back(corner[c]);
    }
    std::sort(old.begin(), old.end());
    old.erase(std::unique(old.begin(), old.end()), old.end());
    return edges;
  }

  void place_vertices(const EdgeNumbers& edges) {
    const std::size_t count = edges.count();
    vertices_.added.resize(count);
    vertices_.position.resize(count);
    fraction_.resize(count);
    parallel_for(count, edges_per_block(field_), [&](std::size_t i) {
      const VertexId a = edges.low(i), b = edges.high(i);
      const double at_a = field_.value[a], at_b = field_.value[b];
      vertices_.added[i] = {a, b, cut_};
      fraction_[i] = zero_on_edge(field_.level_set, group_.placement, pieces_.position(root_, a),
                                  pieces_.position(root_, b), at_a, at_b, field_.distance_kept(at_a, at_b));
      place(i);
    });
  }
  void place(std::size_t i) {
    const Vec3d &from = pieces_.position(root_, vertices_.added[i].a),
                &to = pieces_.position(root_, vertices_.added[i].b);
    vertices_.position[i] = from + fraction_[i] * (to - from);
  }

  /// Cut tets that stay whole go to their side in order; behind them is room for what the crossed tets become.
  void take_whole_cut_tets() {
    std::vector<std::array<std::size_t, 2>> parts(result_.piece.size(), {0, 0}); // of crossed tets, so far
    offset_.resize(crossed_.size());
    for (std::size_t i = 0; i < crossed_.size(); ++i) {
      const auto tets = tets_made(pattern_of(i));
      for (int s = 0; s < 2; ++s) {
        std::size_t& so_far = parts[row_of_piece_[crossed_[i].piece]][s];
        offset_[i][s] = so_far;
        so_far += tets[s];
      }
    }
    first_part_.resize(result_.piece.size());
    auto next_section = section_.begin();
    for (std::size_t g = 0; g < group_.piece.size(); ++g) {
      const std::uint32_t p = group_.piece[g];
      if (sides_.seen[p] != side_crossed) continue;
      const std::vector<CutTet>& old = pieces_.piece[p].cut;
      const std::uint32_t row = row_of_piece_[p];
      const std::array<std::vector<CutTet>*, 2> half = {&result_.below[row], &result_.above[row]};
      std::array<std::size_t, 2>& kept = first_part_[row] = {0, 0};
      for (const std::uint8_t side : sides_.cut[g])
        if (side != side_crossed) ++kept[side == side_above];
      for (int s = 0; s < 2; ++s) half[s]->reserve(kept[s] + parts[row][s]);
      for (std::size_t j = 0; j < old.size(); ++j) {
        const std::uint8_t side = sides_.cut[g][j];
        if (side == side_crossed) continue;
        CutTet& tet = half[side == side_above]->emplace_back(old[j]);
        if (next_section != section_.end() && !next_section->tet.whole && next_section->tet.piece == p &&
            next_section->tet.index == j) {
          tet.face = with_section(tet.face, next_section->faces, cut_);
          ++next_section;
        }
      }
      for (int s = 0; s < 2; ++s) half[s]->resize(kept[s] + parts[row][s]);
    }
  }

  std::array<VertexId, 8> points_of(std::size_t i, const Pattern& pattern) const {
    const Corners& corner = corner_of(i);
    std::array<VertexId, 8> id;
    for (int k = 0; k < 4; ++k) {
      id[k] = corner[pattern.corner[k]];
      id[4 + k] = made_[i][k];
    }
    return id;
  }
  bool positive(const std::array<VertexId, 8>& id, const LocalTet& local) const {
    const auto at = [&](int k) -> const Vec3d& {
      return local[k] < 4 ? pieces_.position(root_, id[local[k]]) : vertices_.position[id[local[k]] - first_added_];
    };
    return orientation(at(0), at(1), at(2), at(3)) > 0;
  }

  /// What the crossed tets become, with the tags of their faces.
  void split_crossed() {
    flat_.assign(crossed_.size(), 0);
    parallel_for(crossed_.size(), tets_per_block, [&](std::size_t i) {
      const TetReference& tet = crossed_[i];
      const Pattern& pattern = pattern_of(i);
      const Tags tags = tags_of(tet, pieces_, boundary_);
      const TetId in = tet.whole ? TetId(tet.index) : pieces_.piece[tet.piece].cut[tet.index].root;
      const auto mask = point_masks(pattern);
      const std::array<VertexId, 8> id = points_of(i, pattern);
      const std::uint32_t row = row_of_piece_[tet.piece];
      std::array<CutTet*, 2> out = {result_.below[row].data() + first_part_[row][0] + offset_[i][0],
                                    result_.above[row].data() + first_part_[row][1] + offset_[i][1]};
      split_tet(pattern, id, [&](bool above, const LocalTet& local) {
        CutTet& part = *out[above]++;
        flat_[i] |= !positive(id, local);
        part.root = in;
        for (int k = 0; k < 4; ++k) {
          part.corner[k] = id[local[k]];
          const auto& c = facet_corners[k];
          const int on = mask[local[c[0]]] & mask[local[c[1]]] & mask[local[c[2]]];
          part.face[k] = FaceTag::interior();
          if (on & 15) {
            int face = 0;
            while (!(on >> face & 1)) ++face;
            part.face[k] = tags[pattern.corner[face]];
          } else if (on & on_section) {
            part.face[k] = FaceTag::section(cut_);
          }
        }
      });
    });
  }

  void pull_until_positive() {
    const auto any_flat = [&] {
      return std::any_of(flat_.begin(), flat_.end(), [](std::uint8_t flat) { return flat; });
    };
    for (std::size_t round = 0; any_flat(); ++round) {
      if (round == pulled_to.size())
        throw SolverFailure("cut: it passes through tets that are too thin for the precision of numbers; cut with a "
                            "larger snap, here and in the cuts before");
      for (std::size_t i = 0; i < crossed_.size(); ++i)
        for (int e = 0; flat_[i] && e < edges_of(pattern_of(i)).count; ++e) {
          const std::size_t row = made_[i][e] - first_added_;
          fraction_[row] = std::clamp(fraction_[row], pulled_to[round], 1 - pulled_to[round]);
          place(row);
        }
      parallel_for(crossed_.size(), tets_per_block, [&](std::size_t i) {
        const Pattern& pattern = pattern_of(i);
        const std::array<VertexId, 8> id = points_of(i, pattern);
        flat_[i] = 0;
        split_tet(pattern, id, [&](bool, const LocalTet& local) { flat_[i] |= !positive(id, local); });
      });
    }
  }

  void find_directions() {
    SectionDirections directions =
        section_directions(pieces_, root_, group_, sides_, field_, vertices_, made_, section_, first_added_);
    for (std::size_t i = 0; i < vertices_.old.size(); ++i)
      result_.on_section.push_back({vertices_.old[i], cut_, directions.old[i]});
    result_.added = std::move(vertices_.added);
    result_.added_position = std::move(vertices_.position);
    result_.added_normal = std::move(directions.added);
  }

  /// Root tets that no piece keeps whole any more: crossed ones, and those that must carry a section face.
  void open_root_tets() {
    for (const TetReference& tet : crossed_)
      if (tet.whole) result_.opened.push_back(TetId(tet.index));
    for (const SectionTet& tet : section_) {
      if (!tet.tet.whole) continue;
      const std::uint32_t row = row_of_piece_[tet.tet.piece];
      const TetId t(tet.tet.index);
      (tet.above ? result_.above : result_.below)[row].push_back(
          {root_.corner[t], t, with_section(tags_of(tet.tet, pieces_, boundary_), tet.faces, cut_)});
      result_.opened.push_back(t);
    }
  }

  const Pieces& pieces_;
  const TetMesh& root_;
  const Boundary& boundary_;
  const PieceGroup& group_;
  const Sides& sides_;
  const GroupField& field_;
  const VertexId first_added_;
  const CutId cut_;
  const std::vector<TetReference>& crossed_;
  std::vector<std::uint32_t> row_of_piece_; ///< of result_.piece
  std::vector<SectionTet> section_;
  std::vector<std::array<VertexId, 4>> made_; ///< the new vertices of each crossed tet
  SectionVertices vertices_;
  std::vector<double> fraction_;                       ///< of its edge, of each new vertex
  std::vector<std::array<std::size_t, 2>> offset_;     ///< of each crossed tet's parts, behind first_part_
  std::vector<std::array<std::size_t, 2>> first_part_; ///< by row of result_.piece: below, above
  std::vector<std::uint8_t> flat_;                     ///< crossed tets of which a part has no volume
  GroupCut result_;
};

} // namespace

GroupCut subdivided(const Pieces& pieces, const TetMesh& root, const Boundary& boundary, const PieceGroup& group,
                    const Sides& sides, const GroupField& field, VertexId first_added) {
  return Subdivision(pieces, root, boundary, group, sides, field, first_added).run();
}

} // namespace pith
