// Far fields by interpolation at Chebyshev nodes: Fong, Darve: The black-box fast multipole method, 2009. Sources and
// fields are kept as Chebyshev moments and series (§2.1); translations that differ by a symmetry of the cube are one
// matrix (Messner, Schanz, Darve: Fast directional multilevel summation, 2012, §4).
//
// Departure: translations are not compressed. What a truncated basis loses is rough, and the systems to be solved
// forgive smooth errors only.
#include "volume/field/chebyshev_box.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace pith {
namespace {

using Square = std::array<std::array<double, cheb>, cheb>;

/// One row of a series.
using Row = Eigen::Array<double, cheb_row, 1>;

Row row_of(const double* at) { return Eigen::Map<const Row>(at); }

double sum_of_products(const Row& row, const Polynomials& t) {
  double sum = 0;
  for (int k = 0; k < cheb; ++k) sum += row[k] * t[k];
  return sum;
}

double node(int i) { return -std::cos(M_PI * (2 * i + 1) / (2 * cheb)); }

/// Row m: the coefficients of the polynomial that is 1 at node m and 0 at the others.
Square interpolation() {
  Square c;
  for (int m = 0; m < cheb; ++m) {
    const Polynomials t = chebyshev(node(m));
    for (int k = 0; k < cheb; ++k) c[m][k] = (k == 0 ? 1.0 : 2.0) / cheb * t[k];
  }
  return c;
}

/// Row k: Tₖ((x ± 1) / 2) in Chebyshev polynomials of x.
Square halving(bool high) {
  const Square c = interpolation();
  Square b{};
  for (int m = 0; m < cheb; ++m) {
    const Polynomials t = chebyshev(0.5 * (node(m) + (high ? 1 : -1)));
    for (int k = 0; k < cheb; ++k)
      for (int j = 0; j < cheb; ++j) b[k][j] += t[k] * c[m][j];
  }
  return b;
}

Square transposed(const Square& a) {
  Square b;
  for (int i = 0; i < cheb; ++i)
    for (int j = 0; j < cheb; ++j) b[i][j] = a[j][i];
  return b;
}

/// The matrices of an axis applied to all three: result_abc = Σ x_ai y_bj z_ck s_ijk.
Series along_axes(const Square& x, const Square& y, const Square& z, const Series& s) {
  Series by_z{}, by_y{}, by_x{};
  for (int ij = 0; ij < cheb * cheb; ++ij)
    for (int c = 0; c < cheb; ++c) {
      double sum = 0;
      for (int k = 0; k < cheb; ++k) sum += z[c][k] * s[ij * cheb_row + k];
      by_z[ij * cheb_row + c] = sum;
    }
  for (int i = 0; i < cheb; ++i)
    for (int b = 0; b < cheb; ++b)
      for (int j = 0; j < cheb; ++j)
        for (int k = 0; k < cheb_row; ++k)
          by_y[(i * cheb + b) * cheb_row + k] += y[b][j] * by_z[(i * cheb + j) * cheb_row + k];
  for (int a = 0; a < cheb; ++a)
    for (int i = 0; i < cheb; ++i)
      for (int jk = 0; jk < cheb * cheb_row; ++jk)
        by_x[a * cheb * cheb_row + jk] += x[a][i] * by_y[i * cheb * cheb_row + jk];
  return by_x;
}

/// The two halvings and their transposes, made once.
struct Halvings {
  std::array<Square, 2> down{halving(false), halving(true)};
  std::array<Square, 2> up{transposed(down[0]), transposed(down[1])};
};
const Halvings& halvings() {
  static const Halvings made;
  return made;
}

double kernel_at(Kernel kernel, const Vec3d& d) {
  const double square = d.squaredNorm(), r = std::sqrt(square);
  return kernel == Kernel::biharmonic ? r : square * r;
}

/// K(nodes of the box at the origin, nodes of the box at `offset` boxes).
Eigen::MatrixXd translation_between_nodes(Kernel kernel, const Vec3d& offset) {
  std::array<Vec3d, cheb_nodes> place;
  for (int j = 0; j < cheb_nodes; ++j) place[j] = cheb_node(j);
  Eigen::MatrixXd k(cheb_nodes, cheb_nodes);
  for (int j = 0; j < cheb_nodes; ++j)
    for (int i = 0; i < cheb_nodes; ++i) k(i, j) = kernel_at(kernel, place[i] - place[j] - 2 * offset);
  return k;
}

/// A symmetry of the cube: component a of the image is component axis[a], its sign turned where bit a is set.
struct Symmetry {
  std::array<int, 3> axis{};
  int mirrored = 0;

  std::array<int, 3> operator()(const std::array<int, 3>& x) const {
    std::array<int, 3> y;
    for (int a = 0; a < 3; ++a) y[a] = mirrored >> a & 1 ? -x[axis[a]] : x[axis[a]];
    return y;
  }
};

std::array<std::uint16_t, cheb_nodes> permuted_nodes(const Symmetry& symmetry) {
  std::array<std::uint16_t, cheb_nodes> to;
  constexpr int last = cheb - 1; // nodes by odd numbers about the middle, so that a mirror turns their signs
  for (int n = 0; n < cheb_nodes; ++n) {
    const auto now = symmetry({2 * (n / (cheb * cheb)) - last, 2 * (n / cheb % cheb) - last, 2 * (n % cheb) - last});
    to[n] =
        static_cast<std::uint16_t>((((now[0] + last) / 2) * cheb + (now[1] + last) / 2) * cheb + (now[2] + last) / 2);
  }
  return to;
}

/// The symmetry that makes all components positive and ascending.
Symmetry sorting(const std::array<int, 3>& offset) {
  Symmetry s{.axis = {0, 1, 2}};
  std::stable_sort(s.axis.begin(), s.axis.end(),
                   [&](int a, int b) { return std::abs(offset[a]) < std::abs(offset[b]); });
  for (int a = 0; a < 3; ++a)
    if (offset[s.axis[a]] < 0) s.mirrored |= 1 << a;
  return s;
}

} // namespace

Polynomials chebyshev(double x) {
  Polynomials t{};
  t[0] = 1;
  t[1] = x;
  for (int k = 2; k < cheb; ++k) t[k] = 2 * x * t[k - 1] - t[k - 2];
  return t;
}

Polynomials chebyshev_slopes(double x) {
  Polynomials slope{}, second{}; // Tₖ' = k Uₖ₋₁
  second[0] = 1;
  second[1] = 2 * x;
  for (int k = 2; k < cheb; ++k) second[k] = 2 * x * second[k - 1] - second[k - 2];
  for (int k = 1; k < cheb; ++k) slope[k] = k * second[k - 1];
  return slope;
}

void add_moments(Series& moments, const Vec3d& x, double weight) {
  const Polynomials tx = chebyshev(x.x()), ty = chebyshev(x.y()), tz = chebyshev(x.z());
  for (int i = 0; i < cheb; ++i)
    for (int j = 0; j < cheb; ++j) {
      const double w = weight * tx[i] * ty[j];
      for (int k = 0; k < cheb_row; ++k) moments[(i * cheb + j) * cheb_row + k] += w * tz[k];
    }
}

double series_value(const Series& series, const Vec3d& x) {
  const Polynomials tx = chebyshev(x.x()), ty = chebyshev(x.y()), tz = chebyshev(x.z());
  Row sum = Row::Zero();
  for (int i = 0; i < cheb; ++i) {
    Row row = Row::Zero();
    for (int j = 0; j < cheb; ++j) row += ty[j] * row_of(series.data() + (i * cheb + j) * cheb_row);
    sum += tx[i] * row;
  }
  return sum_of_products(sum, tz);
}

Vec3d series_gradient(const Series& series, const Vec3d& x) {
  const Polynomials tx = chebyshev(x.x()), ty = chebyshev(x.y()), tz = chebyshev(x.z());
  const Polynomials sx = chebyshev_slopes(x.x()), sy = chebyshev_slopes(x.y()), sz = chebyshev_slopes(x.z());
  Row along_x = Row::Zero(), along_y = Row::Zero(), along_z = Row::Zero();
  for (int i = 0; i < cheb; ++i) {
    Row row = Row::Zero(), slope = Row::Zero();
    for (int j = 0; j < cheb; ++j) {
      const Row s = row_of(series.data() + (i * cheb + j) * cheb_row);
      row += ty[j] * s;
      slope += sy[j] * s;
    }
    along_x += sx[i] * row;
    along_y += tx[i] * slope;
    along_z += tx[i] * row;
  }
  return {sum_of_products(along_x, tz), sum_of_products(along_y, tz), sum_of_products(along_z, sz)};
}

void add_child_moments(Series& parent, const Series& child, int number) {
  const Halvings& h = halvings();
  const Series moved = along_axes(h.down[number & 1], h.down[number >> 1 & 1], h.down[number >> 2 & 1], child);
  for (int i = 0; i < cheb_size; ++i) parent[i] += moved[i];
}

void add_parent_series(Series& child, const Series& parent, int number) {
  const Halvings& h = halvings();
  const Series moved = along_axes(h.up[number & 1], h.up[number >> 1 & 1], h.up[number >> 2 & 1], parent);
  for (int i = 0; i < cheb_size; ++i) child[i] += moved[i];
}

NodeVector node_weights(const Series& moments) {
  static const Square c = interpolation();
  const Series at_nodes = along_axes(c, c, c, moments);
  NodeVector weights;
  for (int n = 0; n < cheb_nodes; ++n) weights[n] = at_nodes[n / cheb * cheb_row + n % cheb];
  return weights;
}

Series series_through(const double* node_values) {
  static const Square c = transposed(interpolation());
  Series at_nodes{};
  for (int n = 0; n < cheb_nodes; ++n) at_nodes[n / cheb * cheb_row + n % cheb] = node_values[n];
  return along_axes(c, c, c, at_nodes);
}

Vec3d cheb_node(int number) {
  return {node(number / (cheb * cheb)), node(number / cheb % cheb), node(number % cheb)};
}

FarOperators far_operators(Kernel kernel) {
  FarOperators operators;
  std::vector<std::array<int, 3>> distinct;
  std::vector<std::pair<std::array<int, 3>, int>> symmetries;
  for (int o = 0; o < 343; ++o) {
    const std::array<int, 3> offset = {o / 49 - 3, o / 7 % 7 - 3, o % 7 - 3};
    const Symmetry turn = sorting(offset);
    const std::array<int, 3> sorted = turn(offset);
    if (sorted[2] <= 1) continue;
    const auto number_in = [](auto& list, const auto& item) {
      const auto found = std::find(list.begin(), list.end(), item);
      if (found != list.end()) return static_cast<int>(found - list.begin());
      list.push_back(item);
      return static_cast<int>(list.size()) - 1;
    };
    const std::size_t known = symmetries.size();
    operators.turn[o] = {.matrix = number_in(distinct, sorted),
                         .permutation = number_in(symmetries, std::pair(turn.axis, turn.mirrored))};
    if (symmetries.size() > known) operators.permutation.push_back(permuted_nodes(turn));
  }
  operators.matrix.resize(distinct.size());
  parallel_for(distinct.size(), 1, [&](std::size_t d) {
    operators.matrix[d] =
        translation_between_nodes(kernel, {double(distinct[d][0]), double(distinct[d][1]), double(distinct[d][2])});
  });
  return operators;
}

} // namespace pith
