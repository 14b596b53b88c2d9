#pragma once
// The axis that strokes give, smooth over a region (Takayama 2008, §5.2.2, Eqs. 1–2; private to the field module).
#include "volume/field/frames.h"
#include "volume/field/polyline.h"

namespace pith {

struct AxisFieldOptions {
  SmoothOptions smoothing;
  /// Strokes give axes without a sign: their tensors t tᵀ are smoothed instead of t, so that opposite strokes agree.
  bool unsigned_axis = false;
  double margin = 0; ///< mm: how far outside the region a stroke's sample still counts
};

struct AxisField {
  PerTet<Vec3d> direction; ///< unit; with `normal` at right angles to it; zero where there is none
  PerTet<float> sine;      ///< of the angle between the axis and `normal`; 1 without
  PerTet<float> agreement; ///< 1: the axis is alike at the tet's corners, 0: it cancels there
  SmoothReport smoothing;
};

/// `normal`: per tet a unit vector that the axis is made perpendicular to, or empty. Signs of unsigned axes agree
/// between neighbours as far as they can, and mostly with the strokes. Messages name `where`, the list of strokes.
/// Errors: InvalidInput when there is no stroke, one has no length or is not finite, or none touches the region.
AxisField axis_field(const TetMesh& mesh, const Locator& locator, std::int32_t region,
                     std::span<const AxisStroke> strokes, std::span<const Vec3d> normal, const std::string& where,
                     const AxisFieldOptions& options);

/// Samples of a polyline in the region, as constraints without a value. `hint` speeds up the search.
struct LocatedSample {
  Location location;
  PolylineSample sample;
};
std::vector<LocatedSample> located_samples(const TetMesh& mesh, const Locator& locator, std::int32_t region,
                                           std::span<const Vec3d> polyline, double spacing, double margin);

/// Some unit vector at right angles to the unit vector s.
Vec3d perpendicular_to(const Vec3d& s);

} // namespace pith
