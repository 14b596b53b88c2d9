// Sparse products: Gustavson: Two fast algorithms for sparse matrices, 1978.
#include "volume/field/sparse_rows.h"

#include "volume/base/parallel.h"

#include <limits>

namespace pith {

void multiply(const SparseRows& a, const LaneVector& x, LaneVector& result) {
  parallel_for(a.rows(), row_block, [&](std::size_t i) { result[i] = row_times(a, i, x); });
}

SparseRows transposed(const SparseRows& a) {
  SparseRows result;
  result.columns = a.rows();
  result.begin.assign(a.columns + 1, 0);
  for (const std::uint32_t c : a.column) ++result.begin[c + 1];
  for (std::size_t c = 0; c < a.columns; ++c) result.begin[c + 1] += result.begin[c];
  result.column.resize(a.column.size());
  result.value.resize(a.value.size());
  std::vector<std::uint32_t> next(result.begin.begin(), result.begin.end() - 1);
  for (std::size_t i = 0; i < a.rows(); ++i)
    for (std::uint32_t k = a.begin[i]; k < a.begin[i + 1]; ++k) {
      const std::uint32_t at = next[a.column[k]]++;
      result.column[at] = static_cast<std::uint32_t>(i);
      result.value[at] = a.value[k];
    }
  return result;
}

SparseRows product(const SparseRows& a, const SparseRows& b) {
  struct Part {
    std::vector<std::uint32_t> length, column;
    std::vector<double> value;
  };
  std::vector<Part> parts((a.rows() + row_block - 1) / row_block);
  parallel_blocks(a.rows(), row_block, [&](std::size_t first, std::size_t last) {
    constexpr std::uint32_t unseen = std::numeric_limits<std::uint32_t>::max();
    Part& part = parts[first / row_block];
    std::vector<std::uint32_t> place(b.columns, unseen);
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t start = part.column.size();
      for (std::uint32_t k = a.begin[i]; k < a.begin[i + 1]; ++k) {
        const std::uint32_t j = a.column[k];
        for (std::uint32_t l = b.begin[j]; l < b.begin[j + 1]; ++l) {
          std::uint32_t& at = place[b.column[l]];
          if (at == unseen) {
            at = static_cast<std::uint32_t>(part.column.size());
            part.column.push_back(b.column[l]);
            part.value.push_back(0);
          }
          part.value[at] += a.value[k] * b.value[l];
        }
      }
      for (std::size_t k = start; k < part.column.size(); ++k) place[part.column[k]] = unseen;
      part.length.push_back(static_cast<std::uint32_t>(part.column.size() - start));
    }
  });
  SparseRows result;
  result.columns = b.columns;
  result.begin.reserve(a.rows() + 1);
  for (const Part& part : parts) {
    for (const std::uint32_t length : part.length) result.begin.push_back(result.begin.back() + length);
    result.column.insert(result.column.end(), part.column.begin(), part.column.end());
    result.value.insert(result.value.end(), part.value.begin(), part.value.end());
  }
  return result;
}

Lanes inner_product(const LaneVector& a, const LaneVector& b) {
  std::vector<Lanes> partial((a.size() + row_block - 1) / row_block, Lanes::Zero());
  parallel_blocks(a.size(), row_block, [&](std::size_t begin, std::size_t end) {
    Lanes sum = Lanes::Zero();
    for (std::size_t i = begin; i < end; ++i) sum += a[i] * b[i];
    partial[begin / row_block] = sum;
  });
  Lanes total = Lanes::Zero();
  for (const Lanes& p : partial) total += p;
  return total;
}

} // namespace pith
