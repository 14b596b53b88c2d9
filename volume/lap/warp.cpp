// Takayama et al. 2008, §5.2.5. The paper minimises, per tet, the differences d_r, d_s, d_t between the transformed
// axes and the texture's; with R̃ = R/|R|² that is |∇u_a − R̃_a|² for each coordinate u_a, so the axes decouple and all
// share one matrix, Σ w ∇λᵢ·∇λⱼ: a discrete Laplacian. We weight by volume (the paper counts tets), so that the
// result does not depend on how finely a place is meshed.
#include "volume/lap/warp.h"

#include <algorithm>
#include <cmath>

namespace pith {

namespace {

/// The clump's Laplacian as compressed rows, without the diagonal's share of pins (the constant is fixed afterwards).
struct Matrix {
  std::vector<std::uint32_t> begin, column;
  std::vector<double> value, diagonal;
};

Matrix laplacian(const Simplices& mesh, const Clump& clump, const std::vector<double>& weight) {
  const int n = mesh.corners;
  const std::size_t vertices = clump.vertex.size(), simplices = clump.simplex.size();
  Matrix m;
  // Incidence: for each vertex the (simplex, corner) pairs, then its row by accumulation over them.
  std::vector<std::uint32_t> first(vertices + 1, 0), incident(simplices * n);
  for (std::uint32_t c : clump.corner) ++first[c + 1];
  for (std::size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
  std::vector<std::uint32_t> fill(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < clump.corner.size(); ++i)
    incident[fill[clump.corner[i]]++] = static_cast<std::uint32_t>(i);

  m.begin.reserve(vertices + 1);
  m.begin.push_back(0);
  m.diagonal.assign(vertices, 0);
  std::vector<std::uint32_t> slot(vertices, Simplices::none);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const std::size_t start = m.column.size();
    for (std::uint32_t k = first[v]; k < first[v + 1]; ++k) {
      const std::uint32_t s = incident[k] / n, i = incident[k] % n;
      const Vec3d* gradient = mesh.gradient.data() + std::size_t(clump.simplex[s]) * n;
      for (int j = 0; j < n; ++j) {
        const double entry = weight[s] * gradient[i].dot(gradient[j]);
        const std::uint32_t u = clump.corner[s * n + j];
        if (u == v) {
          m.diagonal[v] += entry;
        } else if (slot[u] != Simplices::none && slot[u] >= start && m.column[slot[u]] == u) {
          m.value[slot[u]] += entry;
        } else {
          slot[u] = static_cast<std::uint32_t>(m.column.size());
          m.column.push_back(u);
          m.value.push_back(entry);
        }
      }
    }
    m.begin.push_back(static_cast<std::uint32_t>(m.column.size()));
    for (std::size_t k = start; k < m.column.size(); ++k) slot[m.column[k]] = Simplices::none;
  }
  return m;
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
  const Matrix m = laplacian(mesh, clump, weight);
  std::vector<double> b(vertices), x(vertices);
  int iterations = 0;
  for (int axis = 0; axis < axes; ++axis) {
    if (!solve_axis[axis]) continue;
    std::fill(b.begin(), b.end(), 0.0);
    for (std::size_t s = 0; s < clump.simplex.size(); ++s) {
      const Vec3d* gradient = mesh.gradient.data() + std::size_t(clump.simplex[s]) * n;
      for (int i = 0; i < n; ++i) b[clump.corner[s * n + i]] += weight[s] * gradient[i].dot(target[s * axes + axis]);
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
