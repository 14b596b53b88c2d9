#pragma once
// An approximate inverse of a graph Laplacian, by algebraic multigrid (private to the field module).
#include "volume/field/cholesky.h"
#include "volume/field/sparse_rows.h"

#include <vector>

namespace pith {

/// One symmetric positive definite V-cycle for a symmetric matrix with positive diagonal and mostly negative rest.
/// Setup and application are O(entries); the same bits on any number of threads.
class Multigrid {
public:
  explicit Multigrid(SparseRows matrix);

  /// z ≈ A⁻¹ r. Not for two callers at once: the levels keep their work space.
  void apply(const LaneVector& r, LaneVector& z);

  std::size_t level_count() const { return level_.size(); }

private:
  struct Level {
    SparseRows matrix, prolongation, restriction;
    std::vector<double> inverse_diagonal;
    double largest_eigenvalue = 2; ///< a bound, of D⁻¹ A
    LaneVector right, solution, residual, step;
  };
  void cycle(std::size_t level, const LaneVector& r, LaneVector& z);
  static void smooth(Level& level, const LaneVector& r, LaneVector& z, bool from_zero);

  std::vector<Level> level_;
  TiledCholesky coarsest_;
};

} // namespace pith
