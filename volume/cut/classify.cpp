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

/// TetSide of every pattern, plus a bit where the tet may touch the section with a face.
constexpr std::uint8_t touches = 8;
constexpr std::array<std::uint8_t, 81> side_of_code = [] {
  std::array<std::uint8_t, 81> table{};
  for (int code = 0; code < 81; ++code) {
    const Pattern& pattern = patterns[code];
    if (pattern.on == 4)
      table[code] = side_on | touches;
    else
      table[code] = static_cast<std::uint8_t>((pattern.has_below ? side_below : 0) |
                                              (pattern.has_above ? side_above : 0) | (pattern.on == 3 ? touches : 0));
  }
  return table;
}();

void find_states(std::span<const double> value, std::vector<std::uint8_t>& state) {
  state.resize(value.size());
  std::atomic<std::size_t> bad = value.size();
  parallel_blocks(value.size(), vertices_per_block, [&](std::size_t begin, std::size_t end) {
    bool finite = true;
    for (std::size_t v = begin; v < end; ++v) {
      const double x = value[v];
      state[v] = static_cast<std::uint8_t>(1 + (x > 0) - (x < 0));
      finite &= std::abs(x) <= std::numeric_limits<double>::max();
    }
    if (finite) return;
    std::size_t first = begin;
    while (std::isfinite(value[first])) ++first;
    for (std::size_t known = bad; first < known && !bad.compare_exchange_weak(known, first);) {
    }
  });
  if (bad < value.size())
    throw InvalidInput("cut", "the field is " + std::to_string(value[bad]) + " at vertex " + std::to_string(bad),
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

void classify(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, Sides& sides) {
  sides.crossed.clear();
  sides.touching.clear();
  sides.seen.assign(pieces.piece.size(), 0);

  sides.cut.resize(group.piece.size());
  for (std::size_t row = 0; row < group.piece.size(); ++row) {
    const std::uint32_t p = group.piece[row];
    const std::vector<CutTet>& cut = pieces.piece[p].cut;
    std::vector<std::uint8_t>& side = sides.cut[row];
    side.resize(cut.size());
    std::vector<BlockFindings> found((cut.size() + tets_per_block - 1) / tets_per_block);
    parallel_blocks(cut.size(), tets_per_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j)
        side[j] =
            file_tet(sides, {p, static_cast<std::uint32_t>(j), false}, cut[j].corner, found[begin / tets_per_block]);
    });
    for (const std::uint8_t s : side) sides.seen[p] |= s & 3;
    for (const BlockFindings& block : found)
      append(sides.crossed, block.crossed), append(sides.touching, block.touching);
  }

  const std::size_t count = group.everything ? root.tet_count() : group.whole.size();
  sides.whole.resize(count);
  std::vector<BlockFindings> found((count + tets_per_block - 1) / tets_per_block);
  parallel_blocks(count, tets_per_block, [&](std::size_t begin, std::size_t end) {
    BlockFindings& here = found[begin / tets_per_block];
    std::uint32_t last = Pieces::was_cut; // bits are gathered for a run of tets of one piece
    std::uint8_t bits = 0;
    const auto flush = [&] {
      if (last == Pieces::was_cut) return;
      std::atomic_ref<std::uint8_t> seen(sides.seen[last]);
      if ((seen.load(std::memory_order_relaxed) & bits) != bits) seen.fetch_or(bits, std::memory_order_relaxed);
      bits = 0;
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
      bits |= side & 3;
    }
    flush();
  });
  for (const BlockFindings& block : found)
    append(sides.crossed, block.crossed), append(sides.touching, block.touching);
}

/// Vertices of crossed tets that a zero comes too close to.
std::vector<VertexId> snapped_vertices(const Pieces& pieces, const TetMesh& root, const Sides& sides,
                                       std::span<const double> value, double snap) {
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
        const double low = std::abs(value[a]), high = std::abs(value[b]), near = snap * (low + high);
        if (low < near) found[begin / block].push_back(a);
        if (high < near) found[begin / block].push_back(b);
      }
    }
  });
  std::vector<VertexId> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

} // namespace

Sides sides_of(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, std::span<const double> value,
               double snap) {
  Sides sides;
  find_states(value, sides.state);
  classify(pieces, root, group, sides);
  const std::vector<VertexId> snapped = snapped_vertices(pieces, root, sides, value, snap);
  if (snapped.empty()) return sides;
  for (const VertexId v : snapped) sides.state[v] = state_on;
  classify(pieces, root, group, sides);
  return sides;
}

} // namespace pith
