// Takayama et al. 2008, §5.2.5. The paper minimises, per tet, the differences d_r, d_s, d_t between the transformed
// axes and the texture's; with R̃ = R/|R|² that is |∇u_a − R̃_a|² for each coordinate u_a, so the axes decouple and all
// share one matrix, Σ w ∇λᵢ·∇λⱼ: a discrete Laplacian. We weight by volume (the paper counts tets), so that the
// result does not depend on how finely a place is meshed, and may weigh the part of the difference along R̃ less than
// that across it; then each axis has a matrix of its own, with the same pattern.
#include "volume/lap/warp.h"

#include <algorithm>
#include <cmath>

namespace pith {

namespace {

/// A symmetric matrix over the clump's vertices as compressed rows, the diagonal apart. (It is singular: the constant
/// is fixed afterwards.)
struct Matrix {
  std::vector<std::uint32_t> begin, column;
  std::vector<double> value, diagonal;
  /// Per clump simplex and pair i < j of corners, in that order: where their two entries stand.
  std::vector<std::array<std::uint32_t, 2>> entry;
};

/// Rows and columns of a clump's matrix, its values 0.
Matrix pattern_of(const Clump& clump, int n) {
  const std::size_t vertices = clump.vertex.size(), simplices = clump.simplex.size();
  Matrix m;
  // Incidence: for each vertex the (simplex, corner) pairs, then its row over them.
  std::vector<std::uint32_t> first(vertices + 1, 0), incident(simplices * n);
  for (std::uint32_t c : clump.corner) ++first[c + 1];
  for (std::size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
  std::vector<std::uint32_t> fill(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < clump.corner.size(); ++i)
    incident[fill[clump.corner[i]]++] = static_cast<std::uint32_t>(i);

  const int pairs = n * (n - 1) / 2;
  m.entry.resize(simplices * pairs);
  m.begin.reserve(vertices + 1);
  m.begin.push_back(0);
  std::vector<std::uint32_t> slot(vertices, Simplices::none); // of a column in the row at hand, or an older one
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const std::uint32_t start = m.begin.back();
    for (std::uint32_t k = first[v]; k < first[v + 1]; ++k) {
      const std::uint32_t s = incident[k] / n;
      const int i = static_cast<int>(incident[k] % n);
      for (int j = 0; j < n; ++j) {
        if (j == i) continue;
        const std::uint32_t u = clump.corner[s * n + j];
        if (slot[u] == Simplices::none || slot[u] < start) {
          slot[u] = static_cast<std::uint32_t>(m.column.size());
          m.column.push_back(u);
        }
        const int low = std::min(i, j), high = std::max(i, j);
        const int pair = low * (2 * n - low - 1) / 2 + high - low - 1;
        m.entry[s * pairs + pair][i > j] = slot[u];
      }
    }
    m.begin.push_back(static_cast<std::uint32_t>(m.column.size()));
  }
  return m;
}

/// Σ w (∇λᵢ·∇λⱼ − (1 − l) (∇λᵢ·d)(∇λⱼ·d)) over the simplices, with d the direction of the axis' target and l the
/// weight of its length.
void set_values(Matrix& m, const Simplices& mesh, const Clump& clump, const std::vector<double>& weight,
                const std::vector<Vec3d>& target, int axis) {
  const int n = mesh.corners;
  m.value.assign(m.column.size(), 0.0);
  m.diagonal.assign(clump.vertex.size(), 0.0);
  const std::array<std::uint32_t, 2>* entry = m.entry.data();
  for (std::size_t s = 0; s < clump.simplex.size(); ++s) {
    const Vec3d* gradient = mesh.gradient.data() + std::size_t(clump.simplex[s]) * n;
    const Vec3d& t = target[s * clump.axes + axis];
    const double squared = t.squaredNorm();
    const double less = clump.length_weight.empty() || !(squared > 0) ? 0 : (1 - clump.length_weight[s]) / squared;
    for (int i = 0; i < n; ++i) {
      const Vec3d row = weight[s] * (gradient[i] - less * t.dot(gradient[i]) * t);
      m.diagonal[clump.corner[s * n + i]] += row.dot(gradient[i]);
      for (int j = i + 1; j < n; ++j, ++entry)
        for (const double value = row.dot(gradient[j]); const std::uint32_t at : *entry) m.value[at] += value;
    }
  }
}

void multiply(const Matrix& m, const std::vector<double>& x, std::vector<double>& y) {
  for (std::size_t v = 0; v < x.size(); ++v) {
    double sum = m.diagonal[v] * x[v];
    for (std::uint32_t k = m.begin[v]; k < m.begin[v + 1]; ++k) sum += m.value[k] * x[m.column[k]];
    y[v] = sum;
  }
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Preconditioned conjugate gradient on a consistent singular system; x holds the start and the result.
int solve(const Matrix& m, const std::vector<double>& b, std::vector<double>& x, const WarpOptions& options) {
  const std::size_t n = x.size();
  std::vector<double> r(n), z(n), p(n), q(n);
  const auto precondition = [&] {
    for (std::size_t i = 0; i < n; ++i) z[i] = m.diagonal[i] > 0 ? r[i] / m.diagonal[i] : 0;
  };
  multiply(m, x, q);
  for (std::size_t i = 0; i < n; ++i) r[i] = b[i] - q[i];
  for (std::size_t i = 0; i < n; ++i) z[i] = m.diagonal[i] > 0 ? b[i] / m.diagonal[i] : 0;
  const double goal = options.tolerance * options.tolerance * dot(b, z);
  precondition();
  p = z;
  double rz = dot(r, z);
  int iteration = 0;
  for (; iteration < options.max_iterations && rz > goal; ++iteration) {
    multiply(m, p, q);
    const double curvature = dot(p, q);
    if (!(curvature > 0)) break;
    const double step = rz / curvature;
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += step * p[i];
      r[i] -= step * q[i];
    }
    precondition();
    const double next = dot(r, z), ratio = next / rz;
    rz = next;
    for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + ratio * p[i];
  }
  return iteration;
}

} // namespace

int warp(const Simplices& mesh, Clump& clump, const std::vector<Vec3d>& target, const std::vector<double>& weight,
         const std::array<bool, 3>& solve_axis, const std::array<double, 3>& pin,
         const std::array<float, 4>& pin_barycentric, const WarpOptions& options) {
  const int n = mesh.corners, axes = clump.axes;
  const std::size_t vertices = clump.vertex.size();
  Matrix m = pattern_of(clump, n);
  std::vector<double> b(vertices), x(vertices);
  int iterations = 0;
  for (int axis = 0; axis < axes; ++axis) {
    if (!solve_axis[axis]) continue;
    if (m.value.empty() || !clump.length_weight.empty()) set_values(m, mesh, clump, weight, target, axis);
    std::fill(b.begin(), b.end(), 0.0);
    for (std::size_t s = 0; s < clump.simplex.size(); ++s) {
      const Vec3d* gradient = mesh.gradient.data() + std::size_t(clump.simplex[s]) * n;
      const Vec3d pull =
          weight[s] * (clump.length_weight.empty() ? 1 : clump.length_weight[s]) * target[s * axes + axis];
      for (int i = 0; i < n; ++i) b[clump.corner[s * n + i]] += gradient[i].dot(pull);
    }
    for (std::size_t v = 0; v < vertices; ++v) x[v] = clump.coordinate[v * axes + axis];
    iterations += solve(m, b, x, options);
    double at_seed = 0;
    for (int i = 0; i < n; ++i) at_seed += pin_barycentric[i] * x[clump.corner[i]];
    for (std::size_t v = 0; v < vertices; ++v) clump.coordinate[v * axes + axis] = x[v] + (pin[axis] - at_seed);
  }
  return iterations;
}

} // namespace pith
