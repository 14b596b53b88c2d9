#pragma once
// How a fill copies its exemplar: in pieces of what size, and from which places how often.
#include "volume/measure/slice.h"

#include <span>

namespace pith {

/// Areas of connected regions of a section that show one patch, and so one coherent piece of the exemplar.
struct CoherentRegions {
  std::size_t regions = 0;
  double mean_area = 0;    ///< texture widths², plain mean
  double typical_area = 0; ///< weighted by area: the piece in which a random point lies
  double largest_area = 0;
};

/// `slices` have sources; `pixel_area` mm²; areas are in the texture widths of the model's scale field (mm² where it
/// has none). Neighbours are four.
CoherentRegions coherent_regions(const Model& model, std::span<const Slice> slices, double pixel_area);

/// From which cells of the exemplar the solid is made.
struct SourceUse {
  std::size_t points = 0;
  double entropy = 0;    ///< of the uses over a layer of equal depth, over that of even use: 1 = every place as often
  double never_used = 0; ///< share of the cells that no point reads, where an even use would read 8 or more
  double most_used = 0;  ///< the 99th percentile of a cell's uses over the mean of its layer
};

/// Random points of the layer's region read cells × cells × cells of the exemplar (the patch that shows most at each
/// point; wrapped). Uses are compared along the axes that repeat, within each layer along the others, whose use the
/// shape of the solid decides. Precondition: a solid layer, 3 wide.
SourceUse source_use(const Model& model, const Layer& layer, std::size_t points = 200'000, int cells = 8,
                     std::uint64_t seed = 1);

} // namespace pith
