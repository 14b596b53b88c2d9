#pragma once
// What a fill looks like where patches meet, against how it looks inside one.
#include "volume/measure/slice.h"

#include <span>

namespace pith {

struct SeamOptions {
  int bands = 16;               ///< of depth: seams are compared with interiors of the same band
  float pure = 0.98f;           ///< a pixel belongs to a patch's interior when that patch has at least this share
  std::size_t least_pairs = 50; ///< a band counts where it has at least so many pixels of either kind
};

/// Gradients are the Euclidean differences of sRGB-encoded colours between neighbouring pixels. Each figure is a mean
/// over the bands of depth, weighted by what lies in seams.
struct SeamMeasure {
  std::size_t border_pairs = 0;   ///< neighbours whose uppermost patches differ
  std::size_t interior_pairs = 0; ///< neighbours inside one patch
  double border_share = 0;        ///< of all pixels inside, those in a seam band: where two patches or more mix
  /// The 99th percentile of the gradient across borders over that in interiors: above 1 seams show as edges.
  double border_gradient_p99 = 1;
  /// Mean gradient in seam bands over that in interiors: below 1 mixing blurs.
  double band_gradient = 1;
  /// Variance of the colours in seam bands over that in interiors, each about its own mean: below 1 mixing takes
  /// contrast away (half a variance is lost where two unlike patches mix in equal parts).
  double band_variance = 1;
};

/// `slices` have sources (SliceOptions::sources). The ratios are 1 where there is nothing to compare. Errors:
/// InvalidInput for a slice without sources.
SeamMeasure seam_measure(std::span<const Slice> slices, const SeamOptions& options = {});

} // namespace pith
