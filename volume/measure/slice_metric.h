#pragma once
// How close what a fill shows on slices is to its exemplar: the texture distances between windows into the model and
// windows into the exemplar, each over the same figure for one half of the exemplar against the other.
#include "volume/measure/texture_distance.h"
#include "volume/measure/windows.h"

#include <optional>

namespace pith {

struct SliceMetricOptions {
  WindowOptions window;
  TextureDistanceOptions distance{.bands = 4,
                                  .patches = 3072}; ///< bands: 1 is used where the texture does not vary with depth
};

struct SliceMetric {
  TextureDistance distance; ///< model against exemplar
  TextureDistance self;     ///< one half of the exemplar against the other, windows of the same shape and number
  TextureDistance relative; ///< distance over self: 1 is as like the exemplar as the exemplar is itself; 0 patches:
                            ///< nothing could be compared
  std::size_t windows = 0;
  double pixels_left = 0; ///< share of the windows' pixels that were compared (see WindowOptions)
};

/// For one class of slices. `sets` may be given where they were made already (windows_of).
SliceMetric slice_metric(const WindowSets& sets, const SliceMetricOptions& options = {});
SliceMetric slice_metric(const Root& root, const Layer& layer, SliceClass slice_class,
                         const SliceMetricOptions& options = {}, const Progress& progress = {});

/// The slice metric close to a radial axis (the core that a fruit's textures circle, where frames turn fastest) over
/// the one elsewhere.
struct NearAxisMeasure {
  double reach = 0;            ///< mm around the axis that counts as near
  SliceMetric near, elsewhere; ///< all classes together, no pixel left out for its frame
  TextureDistance ratio;       ///< near.relative over elsewhere.relative
};

/// `axis`: a polyline in rest space; near is within `part` of the region's longest extent. None when the region has
/// no tets near it, or none elsewhere, or the exemplar no axis that repeats.
std::optional<NearAxisMeasure> near_axis_measure(const Root& root, const Layer& layer, const std::vector<Vec3d>& axis,
                                                 const SliceMetricOptions& options = {}, double part = 0.05);

} // namespace pith
