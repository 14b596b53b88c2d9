#include "volume/lap/coverage.h"

#include <algorithm>
#include <cmath>

namespace pith {

SampleLattice::SampleLattice(int corners, int order) {
  const float step = 1.0f / order;
  for (int i = order; i >= 0; --i)
    for (int j = order - i; j >= 0; --j) {
      if (corners == 3) {
        barycentric.push_back({i * step, j * step, (order - i - j) * step, 0});
        continue;
      }
      for (int k = order - i - j; k >= 0; --k)
        barycentric.push_back({i * step, j * step, k * step, (order - i - j - k) * step});
    }
}

Coverage::Coverage(int corners, std::span<const float> size, double spacing, int largest_order) {
  // A piece may end within one simplex, however small: where two do, less would see only where one of them is opaque.
  const double least_order = std::min(4, largest_order);
  for (int order = 1; order <= largest_order; ++order) lattice_.emplace_back(corners, order);
  order_.resize(size.size(), 1);
  open_.assign(size.size(), 0);
  begin_.assign(size.size() + 1, 0);
  for (std::size_t i = 0; i < size.size(); ++i) {
    if (size[i] >= 0) {
      order_[i] =
          static_cast<std::uint8_t>(std::clamp(std::ceil(size[i] / spacing), least_order, double(largest_order)));
      open_[i] = 1;
      ++open_count_;
    }
    begin_[i + 1] = begin_[i] + (open_[i] ? lattice_[order_[i] - 1].barycentric.size() : 0);
  }
  value_.assign(begin_.back(), 1.0f);
}

void Coverage::cover(std::uint32_t simplex, std::span<const float> let_through) {
  const std::span<float> at = shining(simplex);
  float most = 0;
  for (std::size_t i = 0; i < at.size(); ++i) most = std::max(most, at[i] *= let_through[i]);
  if (open_[simplex] && most <= 1 / 255.0f) {
    open_[simplex] = 0;
    --open_count_;
  }
}

} // namespace pith
