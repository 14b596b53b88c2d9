#pragma once
// Places where depth turns around although nothing asks it to: local maxima and minima away from its constraints. The
// thin plate overshoots in some concave solids, and a texture that follows such a depth shows bubbles.
#include "volume/field/depth.h"

namespace pith {

struct DepthExtremum {
  VertexId vertex;
  VertexId saddle; ///< where the persistence ends; none in a part of the region that no constraint holds
  Vec3d place = Vec3d::Zero();
  bool maximum = true;
  double depth = 0;
  double persistence = 0; ///< how far depth must fall (rise, from a minimum) on the way to something higher (lower)
};

/// The local extrema of depth over the vertices of a region (neighbours: along edges) that persist by at least
/// `persistence` and do not reach a constrained vertex before they end; the most persistent first. A plateau is one
/// extremum, at its lowest-numbered vertex. O(n log n) (Edelsbrunner, Letscher, Zomorodian 2002).
std::vector<DepthExtremum> extrema_of(const TetMesh& mesh, std::int32_t region, const PerVertex<float>& depth,
                                      const PerVertex<std::uint8_t>& constrained, double persistence = 0.01);

/// The vertices of the region that constraints hold: on the triangles and strokes, and around the strokes' samples.
/// Errors: as depth_field's.
PerVertex<std::uint8_t> constrained_vertices(const TetMesh& mesh, const Boundary& boundary, std::int32_t region,
                                             const std::vector<DepthConstraint>& constraints,
                                             const std::string& where, const DepthOptions& options = {});

} // namespace pith
