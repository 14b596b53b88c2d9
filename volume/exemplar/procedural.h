#pragma once
// Exemplars that pith makes itself: solid textures of named materials, the same bytes every time.
#include "volume/layer/exemplar.h"

#include <string>

namespace pith {

struct ProceduralOptions {
  int resolution = 128; ///< texels along each axis, 16 … 512
  std::uint64_t seed = 1;
};

/// A solid texture by name. Axes: x = R, y = S, z = T of the fill. Along axes that the type leaves free the exemplar
/// repeats (Wrap::repeat, without a seam); along those that it imposes it is clamped.
///
/// kiwi, carrot, tree, pepper, banana, citrus    type 2-b: y is the depth (0 skin, 1 core), z runs along
/// kiwi-flesh                                    the same without seeds
/// watermelon, watermelon-flesh                  type 1-b: y is the depth; with seeds, and without
/// watermelon-striped                            type 2-b: y is the depth, the skin's stripes run along z; no seeds
/// tube, sandstone, shale, brick                 type 2-a: fibres along z; layers and courses across y
/// limestone, conglomerate                       type 0: pebbles
/// sponge, cream, chocolate                      type 0: of a cake
/// mineral                                       type 2-c: y is the depth, z a coordinate along
/// ripening                                      type 2-d: x a coordinate around, y the depth, z along
/// kiwi-seed, watermelon-seed, almond            one thing in the middle, for pasting
///
/// All have the channel "color". Further channels: "height" (mm) of tree and brick, "extinction" (1/mm) and "fiber"
/// (a direction) of tube, "alpha" of the single things. Errors: InvalidInput for an unknown name, and for a
/// resolution beyond 16 … 512. O(resolution³): 128³ takes about 0.2 to 2 s on two cores.
Exemplar procedural_exemplar(const std::string& name, const ProceduralOptions& options = {});

/// The names that procedural_exemplar knows.
std::vector<std::string> procedural_names();

} // namespace pith
