#pragma once
// New vertices: one for each edge that changes sign, placed from the edge's two ends in the order of their ids.
#include "volume/cut/level_set.h"

namespace pith {

/// Numbers edges by first appearance: open addressing, linear probing, half full at most.
class EdgeNumbers {
public:
  /// `most`: no more edges than that will be asked for.
  explicit EdgeNumbers(std::size_t most);

  std::uint32_t number(VertexId a, VertexId b) {
    const std::uint32_t low = std::min(a.value, b.value), high = std::max(a.value, b.value);
    const std::uint64_t key = std::uint64_t(low) << 32 | high;
    std::size_t at = (key * 0x9e3779b97f4a7c15ull) >> shift_;
    for (;; at = (at + 1) & (slot_.size() - 1)) {
      if (slot_[at] == empty) {
        slot_[at] = static_cast<std::uint32_t>(edge_.size());
        edge_.push_back(key);
        return slot_[at];
      }
      if (edge_[slot_[at]] == key) return slot_[at];
    }
  }
  std::size_t count() const { return edge_.size(); }
  VertexId low(std::size_t i) const { return VertexId(edge_[i] >> 32); }
  VertexId high(std::size_t i) const { return VertexId(edge_[i] & 0xffffffffu); }

private:
  static constexpr std::uint32_t empty = 0xffffffffu;
  std::vector<std::uint32_t> slot_;
  std::vector<std::uint64_t> edge_;
  int shift_;
};

/// Where on the edge from a to b (rest space) the field is zero: a fraction in [snap, 1 − snap]. `value_a` and
/// `value_b` have opposite signs, or one is 0. One linear step; then, for a level set that is not linear, up to
/// twelve steps of inverse quadratic interpolation inside a bracket (Brent 1973, §4.2, without his safeguards but
/// bisection), ended when the error left is below about 1e-7 of the edge: two or three values.
double zero_on_edge(const LevelSet* level_set, const Rigid& placement, const Vec3d& a, const Vec3d& b, double value_a,
                    double value_b, double snap);

} // namespace pith
