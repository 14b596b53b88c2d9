#pragma once
// Is every place inside covered, and at what cost: counted from masked, weighted look-ups at random points
// (Takayama 2008, §5.2.6, counts 165 samples per tet; these points are independent of the mesh and of the fill).
#include "volume/base/parallel.h"
#include "volume/layer/model.h"

namespace pith {

struct CoverageOptions {
  std::size_t points = 200'000;
  std::uint64_t seed = 1;
  std::int32_t region = -1; ///< −1: all
  double hole = 0.98;       ///< coverage below which a point counts as a hole; 0.98: what shines through is visible
};

struct CoverageMeasure {
  std::size_t points = 0;
  std::size_t holes = 0; ///< points with a coverage below CoverageOptions::hole
  std::size_t thin = 0;  ///< points that more than 1/255 shines through, holes included
  double least_coverage = 1;
  Vec3d worst = Vec3d::Zero();                               ///< where that is, rest space
  double median_layers = 0, p99_layers = 0, most_layers = 0; ///< look-ups with a positive masked weight at a point
  double median_reads = 0, p99_reads = 0, most_reads = 0;    ///< exemplar reads that material_at takes there
};

/// Over all solid layers together, at points uniform over the volume. The same for any number of threads. 200,000
/// points of a kiwi take about 0.2 s. A region without tets gives points = 0.
CoverageMeasure coverage_measure(const Root& root, const CoverageOptions& options = {},
                                 const Progress& progress = {});

/// What part of a mask's alpha (over its unit cube, in texture space) is good for something, per paste.
struct MaskUse {
  std::size_t patches = 0;   ///< pastes with a mask in a solid layer
  double median_on_tets = 0; ///< alpha on the look-ups that the layer keeps (those that nothing sees are not kept)
  double median_seen = 0;    ///< alpha that shows, after weights and the pastes above
  double p5_seen = 0;        ///< the wasteful end: 5 % of the pastes show less
};

/// From the layer alone: each look-up's tet is sampled at 16 points, which count with the tet's volume in the mask's
/// cube. O(look-ups). Precondition: the layer is solid and fits the mesh.
MaskUse mask_use(const TetMesh& mesh, const Layer& layer);

} // namespace pith
