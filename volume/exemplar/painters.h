#pragma once
// The painters behind procedural_exemplar, one file each. Axes: x = R, y = S, z = T. Where a material changes with
// depth (types 1-b, 2-b, 2-c, 2-d), y is the depth and the painters take it as 1 − radius², which is what the
// thin-plate interpolant of 0 on the skin and 1 on the axis comes close to (see kiwi.h).
#include "volume/exemplar/procedural.h"

namespace pith {

/// The part of the radius at which a depth lies, as all depth-varying exemplars are drawn for.
float radius_at_depth(float depth);

// Type 2-b.
Exemplar carrot_exemplar(const ProceduralOptions& options);
Exemplar tree_exemplar(const ProceduralOptions& options); ///< beside colour: height of the bark, mm
Exemplar pepper_exemplar(const ProceduralOptions& options);
Exemplar banana_exemplar(const ProceduralOptions& options);
Exemplar citrus_exemplar(const ProceduralOptions& options);
Exemplar watermelon_striped_exemplar(const ProceduralOptions& options);
// Type 1-b.
Exemplar watermelon_exemplar(const ProceduralOptions& options, bool seeds);
// Type 2-c and 2-d.
Exemplar mineral_exemplar(const ProceduralOptions& options);
Exemplar ripening_exemplar(const ProceduralOptions& options);
// Type 2-a.
Exemplar tube_exemplar(const ProceduralOptions& options);  ///< beside colour: extinction, fiber
Exemplar brick_exemplar(const ProceduralOptions& options); ///< beside colour: height of its surface, mm
Exemplar sandstone_exemplar(const ProceduralOptions& options);
Exemplar shale_exemplar(const ProceduralOptions& options);
// Type 0.
Exemplar limestone_exemplar(const ProceduralOptions& options);
Exemplar conglomerate_exemplar(const ProceduralOptions& options);
Exemplar sponge_exemplar(const ProceduralOptions& options);
Exemplar cream_exemplar(const ProceduralOptions& options);
Exemplar chocolate_exemplar(const ProceduralOptions& options);
// A thing in the middle of the cube, with alpha; seeds.h has more.
Exemplar almond_exemplar(const ProceduralOptions& options);

} // namespace pith
