#pragma once
// Sizes that a surface may have: beyond them products of its coordinates leave what doubles hold, and geometry fails.
#include "volume/mesh/tri_mesh.h"

#include <string>

namespace pith {

/// Throws InvalidInput, with `name` for the surface, where a triangle reaches farther than 1e12 mm from the origin or
/// all of them together are less than 1e-9 mm across (but not where they all lie at one point). Corners must be in
/// range; a position that is not finite counts as far.
void require_usable_size(const TriMesh& mesh, const std::string& name);

} // namespace pith
