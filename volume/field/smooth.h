#pragma once
// Laplacian smoothing over the vertices of a tet mesh with soft constraints at barycentric positions
// (Takayama 2008, §5.2.2, Eqs. 1–2; Fu et al. 2007).
#include "volume/mesh/locate.h"

#include <span>

namespace pith {

/// Σ λᵢ x_{corner i} = value at a point inside a tet.
struct FieldConstraint {
  TetId tet;
  std::array<double, 4> barycentric{};
  Vec3d value = Vec3d::Zero();
};

struct SmoothOptions {
  double constraint_weight = 10; ///< of a constraint's equation against a vertex's Laplacian
  double tolerance = 1e-6;       ///< of the conjugate gradient: the error's energy norm against the start's
  int max_iterations = 500;
  /// When given (one value per vertex), neighbours are weighted by exp(−((dᵢ − dⱼ)/layer_width)²): smoother within a
  /// layer of equal depth than across (types 2-a and 2-b).
  std::span<const float> depth{};
  double layer_width = 1; ///< depth
};

struct SmoothReport {
  int iterations = 0;
  double residual = 0; ///< in the sense of SmoothOptions::tolerance
};

/// One smooth vector per vertex, each component in a least squares sense: minimal Laplacians under the constraints.
/// Only vertices of tets in `region` (−1: all) take part; the rest are zero, as are parts that no constraint reaches.
/// Cost: O(vertices) by multigrid. The same bytes at 1 or N threads.
/// Errors: InvalidInput without constraints, or when one lies outside the region; SolverFailure when the iteration
/// stalls.
PerVertex<Vec3d> smooth_vectors(const TetMesh& mesh, std::int32_t region,
                                std::span<const FieldConstraint> constraints, const SmoothOptions& options = {},
                                SmoothReport* report = nullptr);

} // namespace pith
