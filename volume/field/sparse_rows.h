#pragma once
// Sparse matrices by compressed rows, applied to several right-hand sides at once (private to the field module).
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace pith {

/// One number for each of up to four right-hand sides.
using Lanes = Eigen::Array<double, 4, 1>;
using LaneVector = std::vector<Lanes>;

struct SparseRows {
  std::size_t columns = 0;
  std::vector<std::uint32_t> begin = {0}; ///< rows + 1
  std::vector<std::uint32_t> column;
  std::vector<double> value;

  std::size_t rows() const { return begin.size() - 1; }
};

/// Rows per task of every parallel loop over rows.
inline constexpr std::size_t row_block = 1024;

/// (A x) at one row; two running sums hide the latency of the additions.
inline Lanes row_times(const SparseRows& a, std::size_t row, const LaneVector& x) {
  Lanes even = Lanes::Zero(), odd = Lanes::Zero();
  const double* const value = a.value.data();
  const std::uint32_t* const column = a.column.data();
  const Lanes* const at = x.data();
  std::uint32_t k = a.begin[row];
  const std::uint32_t end = a.begin[row + 1];
  for (; k + 1 < end; k += 2) {
    even += value[k] * at[column[k]];
    odd += value[k + 1] * at[column[k + 1]];
  }
  if (k < end) even += value[k] * at[column[k]];
  return even + odd;
}

void multiply(const SparseRows& a, const LaneVector& x, LaneVector& result); ///< result = A x, in parallel

SparseRows transposed(const SparseRows& a);
/// A B by Gustavson's algorithm, rows in parallel. Columns of a row stand in the order in which they were met.
SparseRows product(const SparseRows& a, const SparseRows& b);

/// Σ aᵢ bᵢ per lane, summed by blocks in a fixed order.
Lanes inner_product(const LaneVector& a, const LaneVector& b);

} // namespace pith
