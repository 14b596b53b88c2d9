// Both halves of every piece of a group: marching tetrahedra on three states (patterns.h).
#include "volume/cut/subdivide.h"

#include "volume/base/parallel.h"
#include "volume/cut/edge_zero.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace pith {
namespace {

constexpr std::size_t tets_per_block = 1024;
constexpr std::size_t edges_per_block = 512;

using Corners = std::array<VertexId, 4>;
using Tags = std::array<FaceTag, 4>;

Tags tags_of(const TetReference& tet, const Pieces& pieces, const Boundary& boundary) {
  if (!tet.whole) return pieces.piece[tet.piece].cut[tet.index].face;
  Tags tags;
  const auto& facets = boundary.facet_of_tet[TetId(tet.index)];
  for (int i = 0; i < 4; ++i) tags[i] = facets[i].exists() ? FaceTag::skin(facets[i]) : FaceTag::interior();
  return tags;
}

/// A tet that is not subdivided and has faces on the section.
struct SectionTet {
  TetReference tet;
  std::uint8_t faces; ///< bit i: the face opposite corner i
  bool above;
};

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

/// Six times the volume times the gradient of the values' linear interpolation over a tet.
Vec3d weighted_gradient(const Pieces& pieces, const TetMesh& root, const Corners& corner,
                        std::span<const double> value) {
  Vec3d gradient = Vec3d::Zero();
  for (int i = 0; i < 4; ++i) {
    const auto& c = facet_corners[i];
    const Vec3d &p = pieces.position(root, corner[c[0]]), &q = pieces.position(root, corner[c[1]]),
                &r = pieces.position(root, corner[c[2]]);
    gradient -= value[corner[i]] * (q - p).cross(r - p);
  }
  return gradient;
}

Vec3f unit(const Vec3d& direction, const Vec3d& otherwise) {
  const double length = direction.norm();
  if (length > 0 && std::isfinite(length)) return (direction / length).cast<float>();
  const double other = otherwise.norm();
  return other > 0 ? Vec3f((otherwise / other).cast<float>()) : Vec3f::UnitZ();
}

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
  result.added.resize(count);
  result.added_position.resize(count);
  result.added_normal.resize(count);
  result.on_section.resize(old_on.size());
  parallel_for(count, edges_per_block, [&](std::size_t i) {
    const VertexId a = edges.low(i), b = edges.high(i);
    const Vec3d &from = pieces.position(root, a), &to = pieces.position(root, b);
    const double t =
        zero_on_edge(field.level_set, group.placement, from, to, field.value[a], field.value[b], field.snap);
    result.added[i] = {a, b, cut};
    result.added_position[i] = from + t * (to - from);
  });

  // Directions: of the level set where there is one, else of the interpolation, weighted by the tets' volumes.
  const auto across_edge = [&](std::size_t i) {
    const Vec3d along = pieces.position(root, edges.high(i)) - pieces.position(root, edges.low(i));
    return Vec3d(field.value[edges.low(i)] < 0 ? along : Vec3d(-along));
  };
  if (field.level_set) {
    const auto direction = [&](const Vec3d& x) {
      return Vec3d(group.placement.rotation.transpose() * field.level_set->gradient(group.placement(x)));
    };
    parallel_for(count, edges_per_block, [&](std::size_t i) {
      result.added_normal[i] = unit(direction(result.added_position[i]), across_edge(i));
    });
    parallel_for(old_on.size(), edges_per_block, [&](std::size_t i) {
      result.on_section[i] = {old_on[i], cut, unit(direction(pieces.position(root, old_on[i])), Vec3d::UnitZ())};
    });
  } else {
    std::vector<Vec3d> of_tet(crossed.size()), of_edge(count, Vec3d::Zero()), of_old(old_on.size(), Vec3d::Zero());
    parallel_for(crossed.size(), tets_per_block, [&](std::size_t i) {
      of_tet[i] = weighted_gradient(pieces, root, crossed[i].corner(pieces, root), field.value);
    });
    const auto add_to_old = [&](const Corners& corner, const Vec3d& gradient) {
      for (const VertexId v : corner)
        if (sides.state[v] == state_on)
          if (const auto at = std::lower_bound(old_on.begin(), old_on.end(), v); at != old_on.end() && *at == v)
            of_old[at - old_on.begin()] += gradient;
    };
    for (std::size_t i = 0; i < crossed.size(); ++i) {
      const Corners& corner = crossed[i].corner(pieces, root);
      const Pattern& pattern = pattern_of(corner);
      for (int e = 0; e < edges_of(pattern).count; ++e) of_edge[made[i][e] - first_added] += of_tet[i];
      if (pattern.on > 0) add_to_old(corner, of_tet[i]);
    }
    for (const SectionTet& tet : section) {
      const Corners& corner = tet.tet.corner(pieces, root);
      add_to_old(corner, weighted_gradient(pieces, root, corner, field.value));
    }
    for (std::size_t i = 0; i < count; ++i) result.added_normal[i] = unit(of_edge[i], across_edge(i));
    for (std::size_t i = 0; i < old_on.size(); ++i)
      result.on_section[i] = {old_on[i], cut, unit(of_old[i], Vec3d::UnitZ())};
  }

  // Cut tets that stay whole go to their side in order; then what the crossed ones become; then root tets that must
  // carry a section face.
  result.below.resize(result.piece.size());
  result.above.resize(result.piece.size());
  auto next_section = section.begin();
  for (std::size_t g = 0; g < group.piece.size(); ++g) {
    const std::uint32_t p = group.piece[g];
    if (sides.seen[p] != side_crossed) continue;
    const std::vector<CutTet>& old = pieces.piece[p].cut;
    std::vector<CutTet>&below = result.below[row_of_piece[p]], &above = result.above[row_of_piece[p]];
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
  parallel_for(crossed.size(), tets_per_block, [&](std::size_t i) {
    const TetReference& tet = crossed[i];
    const Corners& corner = tet.corner(pieces, root);
    const Pattern& pattern = pattern_of(corner);
    const Tags tags = tags_of(tet, pieces, boundary);
    const TetId in = tet.whole ? TetId(tet.index) : pieces.piece[tet.piece].cut[tet.index].root;
    const auto mask = point_masks(pattern);
    std::array<VertexId, 8> id;
    for (int k = 0; k < 4; ++k) {
      id[k] = corner[pattern.corner[k]];
      id[4 + k] = made[i][k];
    }
    const std::uint32_t row = row_of_piece[tet.piece];
    std::array<CutTet*, 2> out = {result.below[row].data() + offset[i][0], result.above[row].data() + offset[i][1]};
    split_tet(pattern, id, [&](bool above, const LocalTet& local) {
      CutTet& part = *out[above]++;
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
  });

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
