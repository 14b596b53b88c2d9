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

void find_states(const GroupField& field, std::vector<std::uint8_t>& state) {
  const std::span<const double> value = field.value;
  state.resize(value.size());
  const std::size_t count = field.vertex.empty() ? value.size() : field.vertex.size();
  const auto vertex = [&](std::size_t i) { return field.vertex.empty() ? i : std::size_t(field.vertex[i].value); };
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

/// Whole tets come in the order of clusters; all orders must give the same cut.
void sort_by_tet(std::vector<TetReference>& tets, std::size_t begin) {
  const auto before = [](const TetReference& a, const TetReference& b) { return a.index < b.index; };
  if (!std::is_sorted(tets.begin() + begin, tets.end(), before)) std::sort(tets.begin() + begin, tets.end(), before);
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

} // namespace

void classify(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, Sides& sides) {
  sides.crossed.clear();
  sides.touching.clear();
  sides.seen = group.seen_far;
  sides.seen.resize(pieces.piece.size(), 0);

  sides.cut.resize(group.piece.size());
  for (std::size_t row = 0; row < group.piece.size(); ++row) {
    const std::uint32_t p = group.piece[row];
    const std::vector<CutTet>& cut = pieces.piece[p].cut;
    std::vector<std::uint8_t>& side = sides.cut[row];
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
  const std::size_t crossed = sides.crossed.size(), touching = sides.touching.size();
  for (const BlockFindings& block : found)
    append(sides.crossed, block.crossed), append(sides.touching, block.touching);
  sort_by_tet(sides.crossed, crossed);
  sort_by_tet(sides.touching, touching);
}

Sides sides_of(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, const GroupField& field) {
  Sides sides;
  find_states(field, sides.state);
  classify(pieces, root, group, sides);
  const std::vector<VertexId> snapped = snapped_vertices(pieces, root, sides, field);
  if (snapped.empty()) return sides;
  for (const VertexId v : snapped) sides.state[v] = state_on;
  classify(pieces, root, group, sides);
  return sides;
}

} // namespace pith
