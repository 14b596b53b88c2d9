#pragma once
// Are single things (seeds, nuts, stones: sparse layers of pastes, docs/design.md "Single things") seen entire?
// Counted from their own alpha and their look-ups, whatever their colour.
#include "volume/base/parallel.h"
#include "volume/layer/model.h"
#include "volume/measure/points.h"

#include <optional>

namespace pith {

struct ThingOptions {
  std::size_t samples = 500;      ///< points per thing, spread over its alpha
  double seen = 0.98;             ///< a thing is whole when at least this part of its alpha is seen undistorted
  double bend_tolerance = 0.25;   ///< undistorted: no axis is stretched or shrunk by more than this part against the
                                  ///< thing's mean scale, and the map is not mirrored
  double inside_tolerance = 0.02; ///< a thing is cut by the skin when more than this part of it lies outside
  std::uint64_t seed = 1;
};

struct ThingMeasure {
  std::size_t things = 0;
  std::size_t whole = 0;
  std::size_t cut_by_skin = 0; ///< reach out of their region: clipped as asked, not counted as broken
  std::size_t sliced = 0, hidden = 0, bent = 0; ///< the others, by what takes most of them: missing tets or weights
                                                ///< below 1; newer pastes and upper layers; distorted maps
  Spread missing;                               ///< of a thing's alpha, the part that is not seen undistorted
  double worst = 0;                             ///< the largest of those, of things that the skin does not cut
  Vec3d first_broken = Vec3d::Zero();           ///< middle of the lowest-numbered thing that is not whole
  /// Whole things over those that the skin does not cut; 1 when there are none.
  double whole_share() const { return things > cut_by_skin ? double(whole) / double(things - cut_by_skin) : 1; }
};

/// For each patch of the layer with a mask: points distributed like the mask's alpha are carried to rest space by the
/// patch's own look-ups, and what of the mask's alpha is seen there is added up: after weights, under newer look-ups
/// of the layer and under the solid layers above it. Points that no look-up holds are carried by the nearest one: in
/// the region they are sliced off, elsewhere the skin cuts them. None when the layer is not a solid one of three axes
/// that mixes by paste order, or no patch has a mask. The same for any number of threads. Cost: samples · tets per
/// thing, ~1 ms for a seed of 40 tets.
std::optional<ThingMeasure> thing_measure(const Root& root, const Layer& layer, const ThingOptions& options = {},
                                          const Progress& progress = {});

} // namespace pith
