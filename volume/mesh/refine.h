#pragma once
// What all later stages ask of a root mesh, done once before any of them: tets that a depth field can vary in, and
// vertices on the strokes that mark a central axis.
#include "volume/mesh/boundary.h"

namespace pith {

struct RefineOptions {
  /// Split tets whose corners all lie on the boundary: every one of them would carry one depth and have no gradient.
  bool split_skin_tets = true;
  /// Polylines in rest space that should run through vertices, where tets are coarse beside them: the nearest inner
  /// vertex moves onto the stroke where that keeps its tets well shaped.
  std::vector<std::vector<Vec3d>> stroke;
  /// A tet around a moved vertex may not lose more than this part of its quality (inscribed over circumscribed
  /// radius).
  double smallest_quality_kept = 0.5;
};

struct RefineResult {
  TetMesh mesh;                       ///< connected
  Indexed<FacetId, TriangleId> input; ///< as given, for boundary_of(mesh); boundary facets are never split
  std::size_t skin_tets = 0;          ///< tets that had all corners on the boundary
  std::size_t split = 0;              ///< vertices added for them
  std::size_t moved = 0;              ///< vertices moved onto strokes
};

/// `input`: for each facet of boundary_of(mesh) the triangle it came from, or empty. The boundary stays as it is;
/// regions are kept. Cost: O(n). The same mesh in gives the same mesh out.
RefineResult refine(const TetMesh& mesh, const Indexed<FacetId, TriangleId>& input,
                    const RefineOptions& options = {});

} // namespace pith
