#pragma once
// Sums of kernels over far boxes by Chebyshev interpolation (private to the field module; Fong, Darve 2009).
#include "volume/field/radial_kernels.h"

#include <array>

namespace pith {

/// Nodes along each axis of a box. A rougher far field than this one's would spoil the systems of 100,000 centres,
/// whose smallest eigenvalues are some 10⁻¹² of the largest.
inline constexpr int cheb = 9;
inline constexpr int cheb_nodes = cheb * cheb * cheb;    ///< of a box
inline constexpr int cheb_row = (cheb + 3) / 4 * 4;      ///< the last axis is padded to whole vectors of four
inline constexpr int cheb_size = cheb * cheb * cheb_row; ///< numbers of a series, zeros at the end of every row

/// Σ cᵢⱼₖ Tᵢ(x) Tⱼ(y) Tₖ(z) over the box [−1, 1]³, cᵢⱼₖ at (i · cheb + j) · cheb_row + k. The same array holds the
/// moments Σ wₚ Tᵢ Tⱼ Tₖ of sources.
using Series = std::array<double, cheb_size>;

/// T₀ … of one coordinate, and their derivatives; padded with zeros.
using Polynomials = std::array<double, cheb_row>;
Polynomials chebyshev(double x);
Polynomials chebyshev_slopes(double x);

void add_moments(Series& moments, const Vec3d& x, double weight); ///< of one source at x in [−1, 1]³
double series_value(const Series& series, const Vec3d& x);
Vec3d series_gradient(const Series& series, const Vec3d& x);

/// Adds the moments of a child (its number's bits: high x, high y, high z) to its parent's.
void add_child_moments(Series& parent, const Series& child, int number);
/// Adds the parent's series, re-expanded, to a child's.
void add_parent_series(Series& child, const Series& parent, int number);

using NodeVector = std::array<double, cheb_nodes>;
Vec3d cheb_node(int number); ///< in [−1, 1]³
/// Moments as weights at the box's nodes, which act on far places like the sources.
NodeVector node_weights(const Series& moments);
/// The series that interpolates values at the nodes.
Series series_through(const double* node_values);

/// Kernels between the nodes of a box of half width 1 and those of a far one. For boxes of half width h multiply by h
/// (r) or h³ (r³). The 316 offsets are 16 up to the cube's symmetries.
struct FarOperators {
  struct Turn {
    int matrix = -1;      ///< number of the offset up to symmetry; −1: near
    int permutation = -1; ///< of the nodes: node i of the box plays node permutation[i]
  };
  std::vector<Eigen::MatrixXd> matrix;
  std::vector<std::array<std::uint16_t, cheb_nodes>> permutation;
  std::array<Turn, 343> turn; ///< by FarBox::offset
};

FarOperators far_operators(Kernel kernel); ///< kernels r and r³

} // namespace pith
