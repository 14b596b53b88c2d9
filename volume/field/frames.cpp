// Frames for depth-varying textures: Takayama 2008, §5.2.2 (types 2-a and 2-b), scale after §5.2.7.
//
// Departures: a stroke's sample constrains the tet that contains it, not the one with the nearest barycentre; vertex
// vectors are orthogonalised per tet, where the gradient is known, after averaging.
#include "volume/field/frames.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/field/polyline.h"
#include "volume/field/smooth.h"

#include <algorithm>
#include <cmath>

namespace pith {
namespace {

constexpr int samples_per_stroke = 40;
constexpr double stroke_margin = 0.01; ///< of the region's diagonal: how far outside a stroke still counts

Box bounds_of_region(const TetMesh& mesh, std::int32_t region) {
  Box box;
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    if (mesh.region[t] == region)
      for (const VertexId v : mesh.corner[t]) box.add(mesh.position[v]);
  return box;
}

/// Tangents of the strokes at even samples, as constraints of the tets that hold them (Eq. 2).
std::vector<FieldConstraint> tangents_of(const TetMesh& mesh, const Locator& locator, std::int32_t region,
                                         const std::vector<AxisStroke>& strokes, const std::string& where,
                                         double margin) {
  if (strokes.empty())
    throw InvalidInput(where, "there is no stroke", "draw at least one along the texture's second axis");
  std::vector<FieldConstraint> constraints;
  for (std::size_t s = 0; s < strokes.size(); ++s) {
    const std::vector<Vec3d>& point = strokes[s].point;
    const std::string name = where + "[" + std::to_string(s) + "]";
    for (const Vec3d& p : point)
      if (!p.allFinite()) throw InvalidInput(name, "a stroke point is not finite", "give finite coordinates");
    const double length = length_of(point);
    if (!(length > 0))
      throw InvalidInput(name, "a stroke of " + std::to_string(point.size()) + " points has no length",
                         "give at least two distinct points");
    TetId hint;
    for (const PolylineSample& sample : evenly_sampled(point, length / samples_per_stroke)) {
      const Location location = locator.locate(sample.point, region, hint);
      if (!location.tet.exists()) continue;
      Vec3d held = Vec3d::Zero();
      for (int k = 0; k < 4; ++k) held += location.barycentric[k] * mesh.position[mesh.corner[location.tet][k]];
      if (!location.inside && (held - sample.point).norm() > margin) continue;
      hint = location.tet;
      constraints.push_back({location.tet, location.barycentric, sample.tangent});
    }
  }
  if (constraints.empty())
    throw InvalidInput(
        where, "none of its " + std::to_string(strokes.size()) + " strokes touches region " + std::to_string(region),
        "draw one on or inside the region, in the mesh's millimetres");
  return constraints;
}

/// Some unit vector at right angles to the unit vector s.
Vec3d perpendicular_to(const Vec3d& s) {
  int least = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(s[k]) < std::abs(s[least])) least = k;
  return (Vec3d::Unit(least) - s[least] * s).normalized();
}

} // namespace

FrameField frames_from_depth(const TetMesh& mesh, const Locator& locator, std::int32_t region,
                             const DepthField& depth, const std::vector<AxisStroke>& strokes,
                             const std::string& where, const FrameOptions& options) {
  if (depth.value.size() != mesh.vertex_count() || depth.gradient.size() != mesh.tet_count())
    throw InvalidInput(where, "the depth field is of another mesh", "make depth and frames on one mesh");
  const Box box = bounds_of_region(mesh, region);
  if (box.empty())
    throw InvalidInput(where, "the mesh has no region " + std::to_string(region),
                       "name a region from 0 on (one per closed shell of the surface)");
  const double extent = box.extent().maxCoeff();
  const double smallest = options.smallest_scale > 0 ? options.smallest_scale : 0.01 * extent;
  const double largest = options.largest_scale > 0 ? options.largest_scale : extent;
  if (!(smallest <= largest))
    throw InvalidInput(where,
                       "the smallest scale, " + std::to_string(smallest) + " mm, exceeds the largest, " +
                           std::to_string(largest) + " mm",
                       "swap them or leave one at 0");

  const std::vector<FieldConstraint> constraints =
      tangents_of(mesh, locator, region, strokes, where, stroke_margin * box.diagonal());
  SmoothOptions smoothing;
  smoothing.depth = depth.value;
  smoothing.layer_width = options.layer_width;
  FrameField field;
  PerVertex<Vec3d> axis = smooth_vectors(mesh, region, constraints, smoothing, &field.smoothing);
  for (Vec3d& v : axis) {
    const double length = v.norm();
    v = length > 1e-12 ? Vec3d(v / length) : Vec3d::Zero();
  }

  field.axes.assign(mesh.tet_count(), Mat3d::Identity());
  field.scale.assign(mesh.tet_count(), 0.0f);
  field.singular.assign(mesh.tet_count(), 0);
  parallel_for(mesh.tet_count(), 1024, [&](std::size_t i) {
    const TetId t(i);
    if (mesh.region[t] != region) return;
    Vec3d average = Vec3d::Zero();
    for (const VertexId v : mesh.corner[t]) average += axis[v];
    average *= 0.25;
    const double rise = depth.gradient[t].norm(), length = average.norm();
    field.scale[t] = static_cast<float>(rise > 0 ? std::clamp(1 / rise, smallest, largest) : largest);

    const bool level = rise * extent < options.vanishing_rise, lost = length < 1e-6;
    const Vec3d along = lost ? Vec3d::UnitZ() : Vec3d(average / length);
    const Vec3d s = rise > 0 ? Vec3d(depth.gradient[t] / rise) : perpendicular_to(along);
    const Vec3d across = along - along.dot(s) * s;
    const double sine = across.norm();
    const Vec3d aligned = sine > 1e-9 ? Vec3d(across / sine) : perpendicular_to(s);
    field.singular[t] = level || lost || sine < options.singular_sine;
    const Vec3d r = s.cross(aligned).normalized(); // R × S = T
    field.axes[t] << r, s, r.cross(s);
  });
  std::size_t regular = 0;
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) regular += mesh.region[t] == region && !field.singular[t];
  if (regular == 0)
    throw InvalidInput(where, "the strokes run along the depth's gradient everywhere (or the depth is constant)",
                       "draw strokes across the direction in which depth rises");
  return field;
}

} // namespace pith
