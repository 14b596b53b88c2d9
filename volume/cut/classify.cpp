// States of vertices, snapping, and sides of tets: linear passes in blocks of fixed size.
#include "volume/cut/classify.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

namespace pith {
namespace {

constexpr std::size_t tets_per_block = 16384;
constexpr std::size_t vertices_per_block = 65536;

/// TetSide of every pattern, plus a bit where a corner is on.
constexpr std::uint8_t touches = 8;
constexpr std::array<std::uint8_t, 81> side_of_code = [] {
  std::array<std::uint8_t, 81> table{};
  for (int code = 0; code < 81; ++code) {
    const Pattern& pattern = patterns[code];
    if (pattern.on == 4)
      table[code] = side_on | touches;
    else
      table[code] = static_cast<std::uint8_t>((pattern.has_below ? side_below : 0) |
                                              (pattern.has_above ? side_above : 0) | (pattern.on > 0 ? touches : 0));
  }
  return table;
}();

std::uint8_t state_of(double value) { return static_cast<std::uint8_t>(1 + (value > 0) - (value < 0)); }

void find_states(const PieceGroup& group, const GroupField& field, std::vector<std::uint8_t>& state) {
  const std::span<const double> value = field.value;
  state.resize(value.size());
  const std::size_t count = group.everything ? value.size() : field.vertex.size();
  const auto vertex = [&](std::size_t i) { return group.everything ? i : std::size_t(field.vertex[i].value); };
  std::atomic<std::size_t> bad = count;
  parallel_blocks(count, vertices_per_block, [&](std::size_t begin, std::size_t end) {
    bool finite = true;
    for (std::size_t i = begin; i < end; ++i) {
      const double x = value[vertex(i)];
      state[vertex(i)] = state_of(x);
      finite &= std::abs(x) <= std::numeric_limits<double>::max();
    }
    if (finite) return;
    std::size_t first = begin;
    while (std::isfinite(value[vertex(first)])) ++first;
    for (std::size_t known = bad; first < known && !bad.compare_exchange_weak(known, first);) {
    }
  });
  if (bad < count)
    throw InvalidInput(
        "cut", "the field is " + std::to_string(value[vertex(bad)]) + " at vertex " + std::to_string(vertex(bad)),
        "give a field that is finite at every vertex");
}

/// What one block of tets found.
struct BlockFindings {
  std::vector<TetReference> crossed, touching;
};

void append(std::vector<TetReference>& all, const std::vector<TetReference>& block) {
  all.insert(all.end(), block.begin(), block.end());
}

/// Sees to one tet; returns its TetSide.
inline std::uint8_t file_tet(const Sides& sides, const TetReference& tet, const std::array<VertexId, 4>& corner,
                             BlockFindings& found) {
  const std::uint8_t side = side_of_code[sides.pattern_code(corner)];
  if ((side & 3) == side_crossed)
    found.crossed.push_back(tet);
  else if (side & touches)
    found.touching.push_back(tet);
  return side & 7;
}

/// Cut tets by (piece, row), then root tets.
bool before(const TetReference& a, const TetReference& b) {
  if (a.whole != b.whole) return b.whole;
  return a.whole || a.piece == b.piece ? a.index < b.index : a.piece < b.piece;
}
bool same_tet(const TetReference& a, const TetReference& b) { return !before(a, b) && !before(b, a); }

void count_tet(Sides& sides, std::uint32_t piece, std::uint8_t side, int by) {
  for (int half = 0; half < 2; ++half)
    if (side >> half & 1) sides.count[piece][half] += static_cast<std::uint32_t>(by);
}

void find_seen(const PieceGroup& group, Sides& sides) {
  sides.seen = group.seen_far;
  sides.seen.resize(sides.count.size(), 0);
  for (const std::uint32_t p : group.piece)
    for (int half = 0; half < 2; ++half)
      if (sides.count[p][half] > 0) sides.seen[p] |= static_cast<std::uint8_t>(1 << half);
}

/// Vertices of crossed tets that a zero comes too close to.
std::vector<VertexId> snapped_vertices(const Pieces& pieces, const TetMesh& root, const Sides& sides,
                                       const GroupField& field) {
  constexpr std::size_t block = 4096;
  const std::size_t count = sides.crossed.size();
  std::vector<std::vector<VertexId>> found((count + block - 1) / block);
  parallel_blocks(count, block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& corner = sides.crossed[i].corner(pieces, root);
      const Pattern& pattern = patterns[sides.pattern_code(corner)];
      const SplitEdges& edges = split_edges[static_cast<int>(pattern.split)];
      for (int e = 0; e < edges.count; ++e) {
        const VertexId a = corner[pattern.corner[edges.corner[e][0]]], b = corner[pattern.corner[edges.corner[e][1]]];
        const double low = std::abs(field.value[a]), high = std::abs(field.value[b]);
        const double near = std::min(field.snap * (low + high), field.snap_distance);
        if (low < near) found[begin / block].push_back(a);
        if (high < near) found[begin / block].push_back(b);
      }
    }
  });
  std::vector<VertexId> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// The group's cut tets, all of them.
void classify_cut(const Pieces& pieces, const PieceGroup& group, Sides& sides) {
  sides.cut.resize(group.piece.size());
  for (std::size_t row = 0; row < group.piece.size(); ++row) {
    const std::uint32_t p = group.piece[row];
    const std::vector<CutTet>& cut = pieces.piece[p].cut;
    std::vector<std::uint8_t>& side = sides.cut[row];
    for (const std::uint8_t s : side) count_tet(sides, p, s, -1);
    side.resize(cut.size());
    std::vector<BlockFindings> found((cut.size() + tets_per_block - 1) / tets_per_block);
    parallel_blocks(cut.size(), tets_per_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j) {
        const int far = group.far_side(cut[j].root);
        side[j] = far != 0 ? static_cast<std::uint8_t>(far < 0 ? side_below : side_above)
                           : file_tet(sides, {p, static_cast<std::uint32_t>(j), false}, cut[j].corner,
                                      found[begin / tets_per_block]);
      }
    });
    for (const std::uint8_t s : side) count_tet(sides, p, s, 1);
    for (const BlockFindings& block : found)
      append(sides.crossed, block.crossed), append(sides.touching, block.touching);
  }
}

/// The whole root tets that the group looks at.
void classify_whole(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, Sides& sides) {
  const std::size_t count = group.everything ? root.tet_count() : group.whole.size();
  sides.whole.resize(count);
  std::vector<BlockFindings> found((count + tets_per_block - 1) / tets_per_block);
  parallel_blocks(count, tets_per_block, [&](std::size_t begin, std::size_t end) {
    BlockFindings& here = found[begin / tets_per_block];
    std::uint32_t last = Pieces::was_cut; // tets are counted for a run of one piece
    std::array<std::uint32_t, 2> seen = {0, 0};
    const auto flush = [&] {
      if (last == Pieces::was_cut) return;
      for (int half = 0; half < 2; ++half)
        std::atomic_ref<std::uint32_t>(sides.count[last][half]).fetch_add(seen[half], std::memory_order_relaxed);
      seen = {0, 0};
    };
    for (std::size_t i = begin; i < end; ++i) {
      const TetId t = group.everything ? TetId(i) : group.whole[i];
      const std::uint32_t p = pieces.label[t];
      if (p == Pieces::was_cut) {
        sides.whole[i] = side_none;
        continue;
      }
      if (p != last) {
        flush();
        last = p;
      }
      const std::uint8_t side = file_tet(sides, {p, t.value, true}, root.corner[t], here);
      sides.whole[i] = side;
      seen[0] += side & 1;
      seen[1] += side >> 1 & 1;
    }
    flush();
  });
  for (const BlockFindings& block : found)
    append(sides.crossed, block.crossed), append(sides.touching, block.touching);
}

void classify(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, Sides& sides) {
  sides.crossed.clear();
  sides.touching.clear();
  sides.cut.clear();
  sides.count.assign(pieces.piece.size(), {0, 0});
  classify_cut(pieces, group, sides);
  classify_whole(pieces, root, group, sides);
}

/// Adds the whole tets around snapped vertices to the touching ones, where they are neither crossed nor known to
/// touch.
void add_touching(const Pieces& pieces, const PieceGroup& group, const VertexTets& around,
                  std::span<const VertexId> snapped, Sides& sides) {
  std::vector<TetReference> added;
  for (const VertexId v : snapped) {
    if (v >= pieces.root_vertex_count) continue;
    for (const TetId t : around[v]) {
      const std::uint32_t p = pieces.label[t];
      if (p == Pieces::was_cut || !std::binary_search(group.piece.begin(), group.piece.end(), p)) continue;
      if (sides.whole[group.row_of(t)] != side_crossed) added.push_back({p, t.value, true});
    }
  }
  std::sort(added.begin(), added.end(), before);
  std::vector<TetReference> all;
  std::merge(sides.touching.begin(), sides.touching.end(), added.begin(), added.end(), std::back_inserter(all),
             before);
  all.erase(std::unique(all.begin(), all.end(), same_tet), all.end());
  sides.touching = std::move(all);
}

} // namespace

std::size_t PieceGroup::row_of(TetId tet) const {
  if (everything) return tet;
  return static_cast<std::size_t>(std::lower_bound(whole.begin(), whole.end(), tet) - whole.begin());
}

void refile(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, Sides& sides) {
  std::vector<TetReference> near;
  near.reserve(sides.crossed.size() + sides.touching.size());
  std::merge(sides.crossed.begin(), sides.crossed.end(), sides.touching.begin(), sides.touching.end(),
             std::back_inserter(near), before);
  BlockFindings found;
  std::size_t row_of_piece = 0;
  for (const TetReference& tet : near) {
    while (!tet.whole && group.piece[row_of_piece] != tet.piece) ++row_of_piece;
    std::uint8_t& side = tet.whole ? sides.whole[group.row_of(TetId(tet.index))] : sides.cut[row_of_piece][tet.index];
    const std::uint8_t now = file_tet(sides, tet, tet.corner(pieces, root), found);
    if (now == side) continue;
    count_tet(sides, tet.piece, side, -1);
    count_tet(sides, tet.piece, side = now, 1);
  }
  sides.crossed = std::move(found.crossed);
  sides.touching = std::move(found.touching);
  find_seen(group, sides);
}

Sides sides_of(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, const GroupField& field,
               const VertexTets* around, std::vector<std::uint8_t> state) {
  Sides sides;
  sides.state = std::move(state);
  find_states(group, field, sides.state);
  classify(pieces, root, group, sides);
  std::vector<VertexId> snapped = snapped_vertices(pieces, root, sides, field);
  std::sort(snapped.begin(), snapped.end());
  snapped.erase(std::unique(snapped.begin(), snapped.end()), snapped.end());
  for (const VertexId v : snapped) sides.state[v] = state_on;
  if (snapped.empty()) {
    find_seen(group, sides);
  } else if (around) {
    const auto first_whole = [](std::vector<TetReference>& tets) {
      return std::find_if(tets.begin(), tets.end(), [](const TetReference& tet) { return tet.whole; });
    };
    std::vector<TetReference> crossed(first_whole(sides.crossed), sides.crossed.end()),
        touching(first_whole(sides.touching), sides.touching.end());
    sides.crossed.clear();
    sides.touching.clear();
    classify_cut(pieces, group, sides);
    append(sides.crossed, crossed);
    append(sides.touching, touching);
    add_touching(pieces, group, *around, snapped, sides);
    refile(pieces, root, group, sides);
  } else {
    classify(pieces, root, group, sides);
    find_seen(group, sides);
  }
  return sides;
}

} // namespace pith
