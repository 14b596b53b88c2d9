#pragma once
// How much of each simplex is covered: accumulated alpha at sample points inside it (Takayama 2008, §5.2.6).
#include "volume/lap/simplices.h"
#include "volume/layer/mask.h"

#include <span>

namespace pith {

/// The barycentric lattice of order n of a simplex with `corners` corners: (i, j, k, l)/n with i + j + k + l = n.
/// Order 8 of a tet has the paper's 165 points.
struct SampleLattice {
  explicit SampleLattice(int corners, int order);
  std::vector<std::array<float, 4>> barycentric;
};

/// What shines through at every sample of every simplex: 1 uncovered, 0 opaque. Each simplex has a lattice of
/// order 4 at least, whose spacing is at most `spacing` texture widths, up to `largest_order`.
class Coverage {
public:
  /// `size`: for each simplex its longest edge in texture widths; simplices with size < 0 are left out (never open).
  Coverage(int corners, std::span<const float> size, double spacing, int largest_order);

  std::span<const std::array<float, 4>> samples(std::uint32_t simplex) const {
    return lattice_[order_[simplex] - 1].barycentric;
  }
  std::span<float> shining(std::uint32_t simplex) {
    return {value_.data() + begin_[simplex], value_.data() + begin_[simplex + 1]};
  }
  std::span<const float> shining(std::uint32_t simplex) const {
    return {value_.data() + begin_[simplex], value_.data() + begin_[simplex + 1]};
  }
  /// Open: some sample still shines through by more than 1/255.
  bool open(std::uint32_t simplex) const { return open_[simplex]; }
  std::size_t open_count() const { return open_count_; }

  /// Multiplies the samples of a simplex by what a paste lets through, and closes it when all are opaque.
  void cover(std::uint32_t simplex, std::span<const float> let_through);

private:
  std::vector<SampleLattice> lattice_;
  std::vector<std::uint8_t> order_, open_;
  std::vector<std::uint64_t> begin_;
  std::vector<float> value_;
  std::size_t open_count_ = 0;
};

} // namespace pith
