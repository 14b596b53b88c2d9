#pragma once
// The solid exemplar of a kiwi fruit, for a type 2-b fill: x = R around the fruit (periodic), y = S depth (0 skin, 1
// the axis; clamped), z = T along the fruit (periodic).
#include "volume/exemplar/procedural.h"

#include <vector>

namespace pith {

/// The part of the fruit's radius at which a depth lies, as the exemplar is drawn for: the thin-plate interpolant of
/// 0 on the skin and 1 on the axis is close to depth = 1 − radius², so one texture width (1/|∇depth|) is 1/(2 radius)
/// of the fruit's radius: half of it at the skin, 1.2 of it at the seeds.
float kiwi_radius_at_depth(float depth);

/// A seed: an ellipsoid of revolution whose long axis is S, narrower towards the core. Texture widths.
struct KiwiSeed {
  float x, y, z;     ///< centre; x, z in [0, 1)
  float half_length; ///< along y
  float half_width;  ///< along x and z, at the thickest
};

/// Where the seeds are: three staggered rows in each locule, none overlapping another (periodic in x and z), all of
/// them whole and clear of the skin and core.
std::vector<KiwiSeed> kiwi_seeds(std::uint64_t seed);

/// Locules around one texture width; 4π r² of them fit around the fruit at the part r of its radius: 30 at r = 0.43.
inline constexpr int kiwi_locules = 13;

/// One channel: colour (3, sRGB-encoded). Below 128 texels the exemplar is the box average, in linear light, of a
/// finer one; the outermost row of texels is skin at every resolution, since it is what the outside shows.
/// Preconditions as procedural_exemplar, which checks them. O(resolution³): 128³ takes ~0.2 s on two cores.
Exemplar kiwi_exemplar(const ProceduralOptions& options);

/// The same without seeds, for a kiwi whose seeds are scattered on top as whole things.
Exemplar kiwi_flesh_exemplar(const ProceduralOptions& options);

} // namespace pith
