#pragma once
// Exemplars that pith makes itself: solid textures of named materials, the same bytes every time.
#include "volume/layer/exemplar.h"

#include <string>

namespace pith {

struct ProceduralOptions {
  int resolution = 128; ///< texels along each axis, 16 … 512
  std::uint64_t seed = 1;
};

/// Axes of a depth-varying (type 2-b) exemplar: x = R (around the fruit, periodic), y = S (depth: 0 skin, 1 core;
/// clamped), z = T (along the fruit's axis, periodic). Things to paste (seeds) have a channel "alpha" and repeat
/// nowhere.
Exemplar procedural_exemplar(const std::string& name, const ProceduralOptions& options = {});

/// The names that procedural_exemplar knows.
std::vector<std::string> procedural_names();

} // namespace pith
