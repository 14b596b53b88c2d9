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
  double tolerance = 1e-8;       ///< relative residual of the conjugate gradient
  int max_iterations = 2000;
  /// When given (one value per vertex), neighbours are weighted by exp(−((dᵢ − dⱼ)/layer_width)²): smoother within a
  /// layer of equal depth than across (types 2-a and 2-b).
  std::span<const float> depth;
  double layer_width = 1;
};

/// One smooth vector per vertex, each component in a least squares sense: minimal Laplacians under the constraints.
/// Only vertices of tets in `region` (−1: all) take part; the rest are zero. Throws InvalidInput without constraints;
/// SolverFailure when the conjugate gradient stalls. The same bytes at 1 or N threads.
PerVertex<Vec3d> smooth_vectors(const TetMesh& mesh, std::int32_t region,
                                std::span<const FieldConstraint> constraints, const SmoothOptions& options = {});

} // namespace pith
