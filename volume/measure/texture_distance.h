#pragma once
// How far the look of one set of pictures is from another's: the distances that compare a fill with its exemplar.
#include "volume/measure/slice.h"

#include <span>

namespace pith {

struct TextureDistanceOptions {
  int patch = 7;              ///< pixels along a patch's side
  int levels = 3;             ///< of resolution, each half the one before
  int directions = 64;        ///< of the sliced Wasserstein distance
  int bands = 1;              ///< pixels are compared with pixels of the same of so many equal bands of depth only
  std::size_t patches = 8192; ///< most per set and level
  int lag = 12;               ///< largest shift of the autocorrelation, pixels
  std::uint64_t seed = 1;     ///< of the directions
};

/// All are 0 for a set and itself, and in units of the sRGB-encoded value (0 … 1) but the last, which has none. What
/// they see differs: between two samples of one texture the nearest distances rise with what is foreign to it (seams,
/// breaks, bent structure) but not with blur, since a smooth patch is near to many; the distributions (Wasserstein,
/// colour) and the autocorrelation rise with blur and lost contrast. Read them together.
struct TextureDistance {
  double coherence = 0; ///< mean distance of a patch of the first set to the nearest one of the second: is everything
                        ///< that is shown found in the exemplar? (Simakov et al. 2008; mean over the levels)
  double completeness = 0; ///< the other way: is everything of the exemplar shown?
  double wasserstein = 0;  ///< sliced Wasserstein-1 distance of the patches (Rabin et al. 2011; mean over the levels)
  double color = 0;        ///< Wasserstein-1 distance per colour channel, mean of three
  double autocorrelation = 0; ///< root mean square difference of the normalised autocorrelations over all shifts
  std::size_t patches = 0;    ///< that took part at the finest level, of the first set
};

/// `shown` against `exemplar`. Pictures need not have one size; those smaller than a patch count in colour and
/// autocorrelation only. Where a band lacks patches in either set, that band is left out. O(patches · √patches) or
/// so; 8192 patches of 3 levels take about a second on two cores. Errors: InvalidInput for options out of range.
TextureDistance texture_distance(std::span<const Slice> shown, std::span<const Slice> exemplar,
                                 const TextureDistanceOptions& options = {});

/// The Wasserstein-1 distance of two sets of numbers, of any sizes: the area between their quantile functions. 0 when
/// one is empty.
double wasserstein_distance(std::vector<float> a, std::vector<float> b);

/// Each distance over the same figure of `self` (one half of the exemplar against the other): 1 is as good as can be.
TextureDistance relative_to(const TextureDistance& distance, const TextureDistance& self);

} // namespace pith
