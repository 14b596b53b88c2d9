// Which tets of pieces hang together by faces: parting and joining pieces.
#include "volume/base/disjoint_sets.h"
#include "volume/base/error.h"
#include "volume/cut/arrange.h"

#include <algorithm>
#include <string>

namespace pith {
namespace {

using Triple = std::array<std::uint32_t, 3>;
constexpr std::uint32_t none = 0xffffffffu;

Triple face_of(const std::array<VertexId, 4>& corner, int opposite) {
  const auto& c = facet_corners[opposite];
  Triple key = {corner[c[0]], corner[c[1]], corner[c[2]]};
  std::sort(key.begin(), key.end());
  return key;
}

} // namespace

void separate_pieces(Pieces& pieces, const TetMesh& root, CutResult& result) {
  // Nodes: root tets, then the cut tets of fresh halves.
  const std::size_t before = pieces.piece.size();
  std::vector<std::uint32_t> first(before, none); // node of a piece's first cut tet
  std::size_t nodes = root.tet_count();
  for (std::size_t p = 0; p < before; ++p)
    if (result.origin[p].side != 0) {
      first[p] = static_cast<std::uint32_t>(nodes);
      nodes += pieces.piece[p].cut.size();
    }
  DisjointSets sets(nodes);
  const auto fresh = [&](std::uint32_t p) { return p != Pieces::was_cut && first[p] != none; };
  struct Face {
    std::uint32_t piece;
    Triple key;
    std::uint32_t node;
    auto operator<=>(const Face&) const = default;
  };
  std::vector<Face> faces;
  for (const TetId t : all_ids<TetId>(root.tet_count())) {
    const std::uint32_t p = pieces.label[t];
    if (!fresh(p)) continue;
    for (int i = 0; i < 4; ++i) {
      const TetId other = root.neighbor[t][i];
      if (!other.exists()) continue;
      if (pieces.label[other] == p) {
        if (other < t) sets.join(other.value, t.value);
      } else if (pieces.label[other] == Pieces::was_cut) {
        faces.push_back({p, face_of(root.corner[t], i), t.value});
      }
    }
  }
  for (std::uint32_t p = 0; p < before; ++p)
    for (std::size_t j = 0; first[p] != none && j < pieces.piece[p].cut.size(); ++j)
      for (int i = 0; i < 4; ++i)
        if (const CutTet& tet = pieces.piece[p].cut[j]; !tet.face[i].is_section())
          faces.push_back({p, face_of(tet.corner, i), static_cast<std::uint32_t>(first[p] + j)});
  std::sort(faces.begin(), faces.end());
  for (std::size_t i = 0; i + 1 < faces.size(); ++i)
    if (faces[i].piece == faces[i + 1].piece && faces[i].key == faces[i + 1].key)
      sets.join(faces[i].node, faces[i + 1].node);

  // The parts of each piece, by their lowest root tet.
  std::vector<std::uint32_t> lowest(nodes, none);
  const auto look = [&](std::uint32_t node, std::uint32_t tet) {
    std::uint32_t& low = lowest[sets.representative(node)];
    low = std::min(low, tet);
  };
  for (const TetId t : all_ids<TetId>(root.tet_count()))
    if (fresh(pieces.label[t])) look(t.value, t.value);
  for (std::uint32_t p = 0; p < before; ++p)
    for (std::size_t j = 0; first[p] != none && j < pieces.piece[p].cut.size(); ++j)
      look(static_cast<std::uint32_t>(first[p] + j), pieces.piece[p].cut[j].root.value);
  struct Part {
    std::uint32_t piece, low, set;
    auto operator<=>(const Part&) const = default;
  };
  std::vector<Part> parts;
  for (std::uint32_t p = 0; p < before; ++p)
    for (std::size_t j = 0; first[p] != none && j < pieces.piece[p].cut.size(); ++j)
      if (const auto node = static_cast<std::uint32_t>(first[p] + j); sets.representative(node) == node)
        parts.push_back({p, lowest[node], node});
  for (const TetId t : all_ids<TetId>(root.tet_count()))
    if (fresh(pieces.label[t]) && sets.representative(t.value) == t.value)
      parts.push_back({pieces.label[t], lowest[t.value], t.value});
  std::sort(parts.begin(), parts.end());
  std::vector<std::uint32_t> number(nodes, none);
  auto next = static_cast<std::uint32_t>(before);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool keeps = i == 0 || parts[i - 1].piece != parts[i].piece;
    number[parts[i].set] = keeps ? parts[i].piece : next++;
    if (keeps) continue;
    result.origin.push_back(result.origin[parts[i].piece]);
    pieces.piece.push_back({{}, pieces.piece[parts[i].piece].placement});
  }
  if (next == before) return;
  for (const TetId t : all_ids<TetId>(root.tet_count()))
    if (fresh(pieces.label[t])) pieces.label[t] = number[sets.representative(t.value)];
  for (std::uint32_t p = 0; p < before; ++p) {
    if (first[p] == none) continue;
    std::vector<CutTet> all = std::move(pieces.piece[p].cut);
    pieces.piece[p].cut.clear();
    for (std::size_t j = 0; j < all.size(); ++j)
      pieces.piece[number[sets.representative(static_cast<std::uint32_t>(first[p] + j))]].cut.push_back(all[j]);
  }
}

std::vector<std::uint32_t> join_pieces(Pieces& pieces, std::span<const std::uint32_t> named,
                                       const std::string& where) {
  std::vector<bool> joined(pieces.piece.size(), false);
  std::size_t count = 0;
  for (const std::uint32_t p : named) {
    if (p >= pieces.piece.size())
      throw InvalidInput(where,
                         "there is no piece " + std::to_string(p) + " among " + std::to_string(pieces.piece.size()),
                         "name pieces that exist");
    count += !joined[p];
    joined[p] = true;
  }
  if (count < 2) throw InvalidInput(where, "fewer than two pieces are named", "name two that met in a section");

  // Section faces by their corners: where two of the pieces meet.
  struct Face {
    Triple key;
    std::uint32_t piece, row;
    std::uint8_t opposite;
    auto operator<=>(const Face&) const = default;
  };
  std::vector<Face> faces;
  for (std::uint32_t p = 0; p < pieces.piece.size(); ++p)
    for (std::size_t j = 0; joined[p] && j < pieces.piece[p].cut.size(); ++j)
      for (int i = 0; i < 4; ++i)
        if (const CutTet& tet = pieces.piece[p].cut[j]; tet.face[i].is_section())
          faces.push_back({face_of(tet.corner, i), p, static_cast<std::uint32_t>(j), static_cast<std::uint8_t>(i)});
  std::sort(faces.begin(), faces.end());
  DisjointSets sets(pieces.piece.size());
  std::vector<const Face*> met;
  for (std::size_t i = 0; i + 1 < faces.size(); ++i)
    if (faces[i].key == faces[i + 1].key) {
      sets.join(faces[i].piece, faces[i + 1].piece);
      met.push_back(&faces[i]);
      met.push_back(&faces[i + 1]);
    }
  const std::uint32_t target = *std::min_element(named.begin(), named.end());
  for (const std::uint32_t p : named)
    if (sets.representative(p) != target)
      throw InvalidInput(where, "piece " + std::to_string(p) + " shares no section with the others",
                         "join pieces that a cut has parted");

  for (const Face* face : met) pieces.piece[face->piece].cut[face->row].face[face->opposite] = FaceTag::interior();
  std::vector<std::uint32_t> number(pieces.piece.size()), from;
  std::vector<Piece> left;
  pieces.piece[target].placement = Rigid(pieces.piece[named.front()].placement);
  for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) {
    if (joined[p] && p != target) {
      number[p] = number[target];
      std::vector<CutTet>& all = left[number[target]].cut;
      all.insert(all.end(), pieces.piece[p].cut.begin(), pieces.piece[p].cut.end());
      continue;
    }
    number[p] = static_cast<std::uint32_t>(left.size());
    from.push_back(p);
    left.push_back(std::move(pieces.piece[p]));
  }
  for (std::uint32_t& label : pieces.label)
    if (label != Pieces::was_cut) label = number[label];
  pieces.piece = std::move(left);
  return from;
}

} // namespace pith
