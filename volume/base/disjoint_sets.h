#pragma once
// Disjoint sets of 0 .. count − 1 with path halving: what hangs together by pairs.
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace pith {

/// The smallest member stands for its set. Near constant time per call.
class DisjointSets {
public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t representative(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = representative(a), b = representative(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<std::uint32_t> parent_;
};

} // namespace pith
