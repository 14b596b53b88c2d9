// Depth by thin-plate interpolation in 3D: Takayama, Okabe, Ijiri, Igarashi: Lapped solid textures, SIGGRAPH 2008,
// §5.2.2 (after Turk, O'Brien 1999).
//
// Departure: the paper interpolates all constraints; here centres are thinned, since the skin's vertices crowd far
// closer than the smooth interpolant needs, and the vertices left out take their prescribed depths afterwards.
#include "volume/field/depth.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/field/depth_places.h"
#include "volume/field/farthest_points.h"
#include "volume/field/radial_basis.h"

#include <algorithm>
#include <cmath>

namespace pith {
namespace {

/// Points and depths of at most `most` places: stroke samples first, then vertices of the region's boundary.
struct Thinned {
  std::vector<Vec3d> point;
  std::vector<double> value;
};

Thinned thinned(const TetMesh& mesh, const DepthPlaces& places, std::size_t most) {
  Thinned candidates;
  for (const std::uint32_t i : farthest_points(places.sample, most / 2)) {
    candidates.point.push_back(places.sample[i]);
    candidates.value.push_back(places.sample_value[i]);
  }
  const std::size_t samples = candidates.point.size();
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count()))
    if (!std::isnan(places.prescribed[v])) {
      candidates.point.push_back(mesh.position[v]);
      candidates.value.push_back(places.prescribed[v]);
    }
  Thinned result;
  for (const std::uint32_t i : farthest_points(candidates.point, most, samples)) {
    result.point.push_back(candidates.point[i]);
    result.value.push_back(candidates.value[i]);
  }
  return result;
}

} // namespace

DepthField depth_field(const TetMesh& mesh, const Boundary& boundary, std::int32_t region,
                       const std::vector<DepthConstraint>& constraints, const std::string& where,
                       const DepthOptions& options) {
  if (options.max_centers < 8)
    throw InvalidInput(where, "max_centers is " + std::to_string(options.max_centers), "allow at least 8");
  if (!(options.stroke_spacing >= 0) || !std::isfinite(options.stroke_spacing))
    throw InvalidInput(where, "stroke_spacing is " + std::to_string(options.stroke_spacing),
                       "give millimetres, or 0 for a fortieth of the stroke");
  const DepthPlaces places = depth_places(mesh, boundary, region, constraints, where, options);
  const Thinned centers = thinned(mesh, places, static_cast<std::size_t>(options.max_centers));
  const RadialBasis basis = RadialBasis::fit(centers.point, centers.value);

  DepthField field;
  field.centers = basis.center_count();
  field.value.assign(mesh.vertex_count(), 0.0f);
  field.gradient.assign(mesh.tet_count(), Vec3d::Zero());
  std::vector<std::uint8_t> used(mesh.vertex_count(), 0);
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    if (mesh.region[t] == region)
      for (const VertexId v : mesh.corner[t]) used[v] = 1;
  parallel_for(mesh.vertex_count(), 256, [&](std::size_t i) {
    const VertexId v(i);
    if (!used[i]) return;
    const float prescribed = places.prescribed[v];
    field.value[v] =
        std::isnan(prescribed) ? static_cast<float>(std::clamp(basis.value(mesh.position[v]), 0.0, 1.0)) : prescribed;
  });
  parallel_for(mesh.tet_count(), 256, [&](std::size_t i) {
    const TetId t(i);
    if (mesh.region[t] == region) field.gradient[t] = basis.gradient(barycenter(mesh, t));
  });
  return field;
}

} // namespace pith
