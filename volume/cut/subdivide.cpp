// Both halves of every piece of a group: marching tetrahedra on three states (patterns.h).
#include "volume/cut/subdivide.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/cut/edge_zero.h"
#include "volume/cut/section_directions.h"
#include "volume/mesh/orientation.h"

#include <algorithm>
#include <atomic>

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

} // namespace

GroupCut subdivided(const Pieces& pieces, const TetMesh& root, const Boundary& boundary, const PieceGroup& group,
                    const Sides& sides, const GroupField& field, VertexId first_added) {
  const CutId cut(pieces.cut_count);
  GroupCut result;
  std::vector<std::uint32_t> row_of_piece(pieces.piece.size(), 0);
  for (const std::uint32_t p : group.piece)
    if (sides.seen[p] == side_crossed) {
      row_of_piece[p] = static_cast<std::uint32_t>(result.piece.size());
      result.piece.push_back(p);
    }
  if (result.piece.empty()) return result;
  const std::vector<TetReference>& crossed = sides.crossed;
  const std::vector<SectionTet> section = section_tets(pieces, root, boundary, sides);
  result.tets_cut = crossed.size();

  // Number the edges that change sign, in the order of the tets.
  std::vector<std::array<VertexId, 4>> made(crossed.size());
  std::size_t most = 0;
  const auto pattern_of = [&](const Corners& corner) -> const Pattern& {
    return patterns[sides.pattern_code(corner)];
  };
  const auto edges_of = [](const Pattern& p) -> const SplitEdges& { return split_edges[static_cast<int>(p.split)]; };
  for (const TetReference& tet : crossed) most += edges_of(pattern_of(tet.corner(pieces, root))).count;
  EdgeNumbers edges(most);
  std::vector<VertexId> old_on; // older vertices on the section
  for (std::size_t i = 0; i < crossed.size(); ++i) {
    const Corners& corner = crossed[i].corner(pieces, root);
    const Pattern& pattern = pattern_of(corner);
    const SplitEdges& split = edges_of(pattern);
    for (int e = 0; e < split.count; ++e)
      made[i][e] = VertexId(first_added + edges.number(corner[pattern.corner[split.corner[e][0]]],
                                                       corner[pattern.corner[split.corner[e][1]]]));
    for (int k = 0; k < pattern.on; ++k) old_on.push_back(corner[pattern.corner[k]]);
  }
  for (const SectionTet& tet : section) {
    const Corners& corner = tet.tet.corner(pieces, root);
    for (int i = 0; i < 4; ++i)
      if (tet.faces >> i & 1)
        for (const int c : facet_corners[i]) old_on.push_back(corner[c]);
  }
  std::sort(old_on.begin(), old_on.end());
  old_on.erase(std::unique(old_on.begin(), old_on.end()), old_on.end());

  // Place the new vertices.
  const std::size_t count = edges.count();
  SectionVertices vertices{std::vector<AddedVertex>(count), std::vector<Vec3d>(count), std::move(old_on)};
  std::vector<double> fraction(count);
  const auto place = [&](std::size_t i) {
    const Vec3d &from = pieces.position(root, edges.low(i)), &to = pieces.position(root, edges.high(i));
    vertices.position[i] = from + fraction[i] * (to - from);
  };
  parallel_for(count, edges_per_block(field), [&](std::size_t i) {
    const VertexId a = edges.low(i), b = edges.high(i);
    vertices.added[i] = {a, b, cut};
    fraction[i] = zero_on_edge(field.level_set, group.placement, pieces.position(root, a), pieces.position(root, b),
                               field.value[a], field.value[b], field.distance_kept(field.value[a], field.value[b]));
    place(i);
  });

  const auto corners_of = [&](std::size_t i, const Pattern& pattern) {
    const Corners& corner = crossed[i].corner(pieces, root);
    std::array<VertexId, 8> id;
    for (int k = 0; k < 4; ++k) {
      id[k] = corner[pattern.corner[k]];
      id[4 + k] = made[i][k];
    }
    return id;
  };
  // Cut tets that stay whole go to their side in order; then what the crossed ones become; then root tets that must
  // carry a section face.
  result.below.resize(result.piece.size());
  result.above.resize(result.piece.size());
  std::vector<std::array<std::size_t, 2>> parts(result.piece.size(), {0, 0}); // of crossed tets
  for (const TetReference& tet : crossed) {
    const auto tets = tets_made(pattern_of(tet.corner(pieces, root)));
    for (int s = 0; s < 2; ++s) parts[row_of_piece[tet.piece]][s] += tets[s];
  }
  auto next_section = section.begin();
  for (std::size_t g = 0; g < group.piece.size(); ++g) {
    const std::uint32_t p = group.piece[g];
    if (sides.seen[p] != side_crossed) continue;
    const std::vector<CutTet>& old = pieces.piece[p].cut;
    std::vector<CutTet>&below = result.below[row_of_piece[p]], &above = result.above[row_of_piece[p]];
    std::array<std::size_t, 2> kept = {0, 0};
    for (const std::uint8_t side : sides.cut[g])
      if (side != side_crossed) ++kept[side == side_above];
    below.reserve(kept[0] + parts[row_of_piece[p]][0]);
    above.reserve(kept[1] + parts[row_of_piece[p]][1]);
    for (std::size_t j = 0; j < old.size(); ++j) {
      const std::uint8_t side = sides.cut[g][j];
      if (side == side_crossed) continue;
      std::vector<CutTet>& half = side == side_above ? above : below;
      half.push_back(old[j]);
      if (next_section != section.end() && !next_section->tet.whole && next_section->tet.piece == p &&
          next_section->tet.index == j) {
        half.back().face = with_section(half.back().face, next_section->faces, cut);
        ++next_section;
      }
    }
  }
  std::vector<std::array<std::uint32_t, 2>> offset(crossed.size());
  std::vector<std::array<std::size_t, 2>> size(result.piece.size());
  for (std::size_t r = 0; r < size.size(); ++r) size[r] = {result.below[r].size(), result.above[r].size()};
  for (std::size_t i = 0; i < crossed.size(); ++i) {
    const auto tets = tets_made(pattern_of(crossed[i].corner(pieces, root)));
    for (int s = 0; s < 2; ++s) {
      offset[i][s] = static_cast<std::uint32_t>(size[row_of_piece[crossed[i].piece]][s]);
      size[row_of_piece[crossed[i].piece]][s] += tets[s];
    }
  }
  for (std::size_t r = 0; r < size.size(); ++r) {
    result.below[r].resize(size[r][0]);
    result.above[r].resize(size[r][1]);
  }
  std::vector<std::uint8_t> flat(crossed.size(), 0); // crossed tets of which rounding left a part without volume
  std::atomic<bool> any_flat = false;
  const auto positive = [&](const std::array<VertexId, 8>& id, const LocalTet& local) {
    const auto at = [&](int k) -> const Vec3d& {
      return local[k] < 4 ? pieces.position(root, id[local[k]]) : vertices.position[id[local[k]] - first_added];
    };
    return orientation(at(0), at(1), at(2), at(3)) > 0;
  };
  parallel_for(crossed.size(), tets_per_block, [&](std::size_t i) {
    const TetReference& tet = crossed[i];
    const Corners& corner = tet.corner(pieces, root);
    const Pattern& pattern = pattern_of(corner);
    const Tags tags = tags_of(tet, pieces, boundary);
    const TetId in = tet.whole ? TetId(tet.index) : pieces.piece[tet.piece].cut[tet.index].root;
    const auto mask = point_masks(pattern);
    const std::array<VertexId, 8> id = corners_of(i, pattern);
    const std::uint32_t row = row_of_piece[tet.piece];
    std::array<CutTet*, 2> out = {result.below[row].data() + offset[i][0], result.above[row].data() + offset[i][1]};
    split_tet(pattern, id, [&](bool above, const LocalTet& local) {
      CutTet& part = *out[above]++;
      flat[i] |= !positive(id, local);
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
          part.face[k] = FaceTag::section(cut);
        }
      }
    });
    if (flat[i]) any_flat = true;
  });

  for (std::size_t round = 0; any_flat; ++round) {
    if (round == pulled_to.size())
      throw SolverFailure("cut: it passes through tets that are too thin for the precision of numbers; cut with a "
                          "larger snap, here and in the cuts before");
    for (std::size_t i = 0; i < crossed.size(); ++i)
      for (int e = 0; flat[i] && e < edges_of(pattern_of(crossed[i].corner(pieces, root))).count; ++e) {
        const std::size_t row = made[i][e] - first_added;
        fraction[row] = std::clamp(fraction[row], pulled_to[round], 1 - pulled_to[round]);
        place(row);
      }
    any_flat = false;
    parallel_for(crossed.size(), tets_per_block, [&](std::size_t i) {
      const Pattern& pattern = pattern_of(crossed[i].corner(pieces, root));
      const std::array<VertexId, 8> id = corners_of(i, pattern);
      flat[i] = 0;
      split_tet(pattern, id, [&](bool, const LocalTet& local) { flat[i] |= !positive(id, local); });
      if (flat[i]) any_flat = true;
    });
  }

  SectionDirections directions =
      section_directions(pieces, root, group, sides, field, vertices, made, section, first_added);
  for (std::size_t i = 0; i < vertices.old.size(); ++i)
    result.on_section.push_back({vertices.old[i], cut, directions.old[i]});
  result.added = std::move(vertices.added);
  result.added_position = std::move(vertices.position);
  result.added_normal = std::move(directions.added);

  for (const TetReference& tet : crossed)
    if (tet.whole) result.opened.push_back(TetId(tet.index));
  for (const SectionTet& tet : section) {
    if (!tet.tet.whole) continue;
    const std::uint32_t row = row_of_piece[tet.tet.piece];
    const TetId t(tet.tet.index);
    (tet.above ? result.above : result.below)[row].push_back(
        {root.corner[t], t, with_section(tags_of(tet.tet, pieces, boundary), tet.faces, cut)});
    result.opened.push_back(t);
  }
  return result;
}

} // namespace pith
