// Control of extrema by inequalities along edges: Jacobson, Weinkauf, Sorkine: Smooth shape-aware functions with
// controlled extrema, 2012, §4: a harmonic field has no extrema inside, and any field that rises along one edge up
// and one edge down of it at each vertex has none either.
//
// Departure: instead of a quadratic program the inequalities are met by two sweeps in the harmonic field's order. One
// raises what is too low for its lower neighbours, one lowers what is too high for its higher ones; each result meets
// all of them, and so does the mean. The change is smoothed over the mesh and the sweeps are done again.
#include "volume/field/monotone_depth.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/field/multigrid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pith {
namespace {

/// Along the edges that the inequalities use, the result rises by at least this part of what the harmonic field does.
constexpr double least_rise = 0.3;
/// Smaller rises of the harmonic field are its solver's noise.
constexpr double least_guide_rise = 1e-7;
constexpr int rounds = 6, smoothing_steps = 12;

struct Part {
  std::vector<VertexId> vertex;    ///< of the region, ascending
  PerVertex<std::uint32_t> number; ///< within `vertex`
  VertexNeighbors neighbors;       ///< by `number`
  std::vector<std::uint8_t> fixed; ///< by `number`
};

Part part_of(const TetMesh& mesh, std::int32_t region, const PerVertex<std::uint8_t>& fixed) {
  constexpr std::uint32_t absent = ~0u;
  Part part;
  part.number.assign(mesh.vertex_count(), absent);
  TetMesh kept;
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    if (mesh.region[t] == region) {
      kept.corner.push_back(mesh.corner[t]);
      for (const VertexId v : mesh.corner[t]) part.number[v] = 0;
    }
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count()))
    if (part.number[v] != absent) {
      part.number[v] = static_cast<std::uint32_t>(part.vertex.size());
      part.vertex.push_back(v);
      part.fixed.push_back(fixed[v]);
    }
  for (auto& corner : kept.corner)
    for (VertexId& v : corner) v = VertexId(part.number[v]);
  kept.position.resize(part.vertex.size());
  part.neighbors = vertices_around_vertices(kept);
  return part;
}

/// Positive weights, so that the discrete maximum principle holds on any mesh: squared inverse lengths.
double weight_of(const TetMesh& mesh, VertexId a, VertexId b) {
  return 1 / std::max(1e-300, (mesh.position[a] - mesh.position[b]).squaredNorm());
}

/// The discrete harmonic field through the fixed values.
std::vector<double> harmonic(const TetMesh& mesh, const Part& part, const std::vector<double>& value) {
  constexpr std::uint32_t absent = ~0u;
  std::vector<std::uint32_t> row(part.vertex.size(), absent), of_row;
  for (std::uint32_t i = 0; i < part.vertex.size(); ++i)
    if (!part.fixed[i]) {
      row[i] = static_cast<std::uint32_t>(of_row.size());
      of_row.push_back(i);
    }
  const std::size_t n = of_row.size();
  SparseRows a;
  a.columns = n;
  LaneVector right(n, Lanes::Zero());
  std::vector<double> diagonal(n);
  for (std::size_t r = 0; r < n; ++r) {
    const std::size_t at = a.value.size();
    a.column.push_back(static_cast<std::uint32_t>(r));
    a.value.push_back(0);
    const std::uint32_t i = of_row[r];
    for (const VertexId j : part.neighbors[VertexId(i)]) {
      const double w = weight_of(mesh, part.vertex[i], part.vertex[j]);
      a.value[at] += w;
      if (part.fixed[j]) {
        right[r][0] += w * value[j];
      } else {
        a.column.push_back(row[j]);
        a.value.push_back(-w);
      }
    }
    a.begin.push_back(static_cast<std::uint32_t>(a.column.size()));
    diagonal[r] = a.value[at];
  }
  // Rows scaled to a unit diagonal, symmetrically: edges differ much in length.
  std::vector<double> scale(n);
  for (std::size_t r = 0; r < n; ++r) scale[r] = diagonal[r] > 0 ? 1 / std::sqrt(diagonal[r]) : 1;
  for (std::size_t r = 0; r < n; ++r) {
    for (std::uint32_t k = a.begin[r]; k < a.begin[r + 1]; ++k) a.value[k] *= scale[r] * scale[a.column[k]];
    right[r] *= scale[r];
  }

  std::vector<double> result = value;
  if (n == 0) return result;
  Multigrid multigrid(a);
  LaneVector x(n, Lanes::Zero()), r = right, z(n, Lanes::Zero()), p, q(n);
  multigrid.apply(r, z);
  p = z;
  double rz = inner_product(r, z)[0];
  const double goal = 1e-20 * rz; // tight: order between neighbours is read from the result
  for (int iteration = 0; rz > goal && rz > 0; ++iteration) {
    if (iteration >= 500)
      throw SolverFailure("the harmonic depth of " + std::to_string(n) + " vertices did not converge",
                          std::sqrt(rz / std::max(goal, 1e-300)));
    multiply(a, p, q);
    const double alpha = rz / inner_product(p, q)[0];
    parallel_for(n, row_block, [&](std::size_t i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * q[i];
    });
    multigrid.apply(r, z);
    const double next = inner_product(r, z)[0];
    parallel_for(n, row_block, [&](std::size_t i) { p[i] = z[i] + (next / rz) * p[i]; });
    rz = next;
  }
  for (std::size_t k = 0; k < n; ++k) result[of_row[k]] = scale[k] * x[k][0];
  return result;
}

/// high ≥ low + rise.
struct Inequality {
  std::uint32_t low, high;
  double rise;
};

/// One edge up and one down at every free vertex: among those along which the harmonic field rises and falls, the one
/// along which `value` does so most. A vertex that lacks one (the harmonic field is level there: nothing beyond it is
/// constrained) is pinned to the harmonic field.
std::vector<Inequality> inequalities_of(const Part& part, const std::vector<double>& guide,
                                        const std::vector<double>& value, std::vector<std::uint8_t>& pinned) {
  std::vector<Inequality> result;
  for (std::uint32_t i = 0; i < part.vertex.size(); ++i) {
    if (part.fixed[i]) continue;
    std::uint32_t up = i, down = i;
    for (const VertexId j : part.neighbors[VertexId(i)]) {
      if (guide[j] > guide[i] + least_guide_rise && (up == i || value[j] > value[up])) up = j;
      if (guide[j] < guide[i] - least_guide_rise && (down == i || value[j] < value[down])) down = j;
    }
    if (up == i || down == i) {
      pinned[i] = 1;
      continue;
    }
    result.push_back({i, up, least_rise * (guide[up] - guide[i])});
    result.push_back({down, i, least_rise * (guide[i] - guide[down])});
  }
  return result;
}

class Sweeps {
public:
  /// `pinned` vertices have their value in the guide.
  Sweeps(const std::vector<std::uint8_t>& pinned, const std::vector<double>& guide,
         std::vector<Inequality> inequalities)
      : pinned_(pinned), upward_(std::move(inequalities)), downward_(upward_) {
    std::sort(upward_.begin(), upward_.end(), [&](const Inequality& a, const Inequality& b) {
      return std::tuple(guide[a.high], a.high, a.low) < std::tuple(guide[b.high], b.high, b.low);
    });
    std::sort(downward_.begin(), downward_.end(), [&](const Inequality& a, const Inequality& b) {
      return std::tuple(-guide[a.low], a.low, a.high) < std::tuple(-guide[b.low], b.low, b.high);
    });
    // What the fixed vertices leave room for; the guide itself lies between.
    least_.assign(guide.size(), 0.0);
    most_.assign(guide.size(), 1.0);
    for (std::size_t i = 0; i < guide.size(); ++i)
      if (pinned[i]) least_[i] = most_[i] = guide[i];
    raise(least_);
    lower(most_);
  }

  std::vector<double> apply(std::vector<double> value) const {
    for (std::size_t i = 0; i < value.size(); ++i)
      value[i] = std::max(std::min(value[i], most_[i]), std::min(least_[i], most_[i]));
    std::vector<double> raised = value, lowered = value;
    raise(raised);
    lower(lowered);
    for (std::size_t i = 0; i < value.size(); ++i) value[i] = 0.5 * (raised[i] + lowered[i]);
    return value;
  }

private:
  void raise(std::vector<double>& value) const {
    for (const Inequality& q : upward_)
      if (!pinned_[q.high]) value[q.high] = std::max(value[q.high], value[q.low] + q.rise);
  }
  void lower(std::vector<double>& value) const {
    for (const Inequality& q : downward_)
      if (!pinned_[q.low]) value[q.low] = std::min(value[q.low], value[q.high] - q.rise);
  }

  const std::vector<std::uint8_t>& pinned_;
  std::vector<Inequality> upward_, downward_; ///< in the order of their higher, and of their lower ends
  std::vector<double> least_, most_;
};

/// Means with the neighbours, a few times; pinned vertices stay.
void smooth(const Part& part, const std::vector<std::uint8_t>& pinned, std::vector<double>& value) {
  for (int step = 0; step < smoothing_steps; ++step) {
    std::vector<double> next = value;
    parallel_for(value.size(), 1024, [&](std::size_t i) {
      if (pinned[i]) return;
      double sum = 0;
      for (const VertexId j : part.neighbors[VertexId(i)]) sum += value[j];
      const std::size_t count = part.neighbors[VertexId(i)].size();
      if (count > 0) next[i] = 0.5 * value[i] + 0.5 * sum / static_cast<double>(count);
    });
    value = std::move(next);
  }
}

} // namespace

PerVertex<float> monotone_depth(const TetMesh& mesh, std::int32_t region, const PerVertex<float>& depth,
                                const PerVertex<std::uint8_t>& fixed) {
  const Part part = part_of(mesh, region, fixed);
  std::vector<double> given(part.vertex.size());
  for (std::size_t i = 0; i < given.size(); ++i) given[i] = depth[part.vertex[i]];
  const std::vector<double> guide = harmonic(mesh, part, given);
  std::vector<std::uint8_t> pinned = part.fixed;
  std::vector<Inequality> inequalities = inequalities_of(part, guide, given, pinned);
  const Sweeps sweeps(pinned, guide, std::move(inequalities));
  std::vector<double> value = sweeps.apply(given);
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> change(value.size());
    for (std::size_t i = 0; i < value.size(); ++i) change[i] = value[i] - given[i];
    smooth(part, pinned, change);
    for (std::size_t i = 0; i < value.size(); ++i) change[i] += given[i];
    value = sweeps.apply(std::move(change));
  }
  PerVertex<float> result = depth;
  for (std::size_t i = 0; i < value.size(); ++i)
    if (!part.fixed[i]) result[part.vertex[i]] = static_cast<float>(std::clamp(value[i], 0.0, 1.0));
  return result;
}

} // namespace pith
