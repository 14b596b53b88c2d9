#pragma once
// Where depth is prescribed: the constraints as vertices and stroke samples (private to the field module).
#include "volume/field/depth.h"
#include "volume/field/polyline.h"

namespace pith {

/// The constraints, checked against the mesh and against one another.
struct DepthPlaces {
  PerVertex<float> prescribed; ///< per vertex of the mesh; NaN where depth is free
  std::vector<Vec3d> sample;   ///< of strokes, near or in the region
  std::vector<double> sample_value;
};

/// Errors: as depth_field's.
DepthPlaces depth_places(const TetMesh& mesh, const Boundary& boundary, std::int32_t region,
                         const std::vector<DepthConstraint>& constraints, const std::string& where,
                         const DepthOptions& options);

/// 1 at vertices with a prescribed depth, at the vertex of the region nearest to each sample, and at the other
/// corners of the tet, face or edge there that contains the sample: what depth is asked for there lies between
/// theirs.
PerVertex<std::uint8_t> held_vertices(const TetMesh& mesh, std::int32_t region, const DepthPlaces& places);

} // namespace pith
