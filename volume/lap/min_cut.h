#pragma once
// The cheapest way to part a graph in two (private to the lap module).
#include <cstdint>
#include <span>
#include <vector>

namespace pith {

/// An edge between two nodes: what it costs when they end up on different sides, the same either way.
struct CutEdge {
  std::uint32_t a, b;
  std::int64_t cost;
};

/// For each node 1 where it is on the source's side of a minimum cut, else 0. `source` and `sink`: what it costs to
/// part each node from them; `never` cannot be parted. Nodes that nothing ties to either side fall to the sink.
/// Boykov, Kolmogorov: An experimental comparison of min-cut/max-flow algorithms (PAMI 2004), by Boost.
inline constexpr std::int64_t never = std::int64_t(1) << 40;
std::vector<std::uint8_t> min_cut(std::span<const std::int64_t> source, std::span<const std::int64_t> sink,
                                  std::span<const CutEdge> edges);

} // namespace pith
