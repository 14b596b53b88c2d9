#pragma once
// Asks a model for its material at many random inside points.
#include "volume/base/parallel.h"
#include "volume/layer/model.h"

#include <vector>

namespace pith::cli {

struct Survey {
  std::size_t points = 0;
  std::size_t holes = 0; ///< points that more than 2 % shines through: visible
  std::size_t thin = 0;  ///< points that more than 1/255 shines through, holes included
  double least_coverage = 1;
  Vec3d worst = Vec3d::Zero();                                  ///< where that is, rest space
  double median_lookups = 0, p99_lookups = 0, most_lookups = 0; ///< exemplar reads that a point took
};

/// Points are uniform over the root's volume: a function of (seed, number) alone. In parallel.
Survey survey_of(const Root& root, std::size_t points, std::uint64_t seed, const Progress& progress = {});

} // namespace pith::cli
