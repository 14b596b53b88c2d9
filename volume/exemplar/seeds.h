#pragma once
// Seeds as things to paste: a volume that is opaque where the seed is, and nothing outside (channels "color" and
// "alpha"). Axis 1 (S) is the seed's long axis, its point towards 1, where the core is; axis 2 (T) is across its
// broad side.
#include "volume/exemplar/procedural.h"

namespace pith {

/// A kiwi's: a drop, nearly black, with the sheen of its wet coat and a dark, half transparent veil of flesh around
/// it.
Exemplar kiwi_seed_exemplar(const ProceduralOptions& options);

/// A watermelon's: a flat drop, dark brown, paler along its edge, without veil.
Exemplar watermelon_seed_exemplar(const ProceduralOptions& options);

} // namespace pith
