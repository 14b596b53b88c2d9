#pragma once
// A word for who draws a stroke in other units than the surface's (private to the field module).
#include "volume/mesh/tet_mesh.h"

#include <span>
#include <string>

namespace pith {

/// What to do about a stroke that lies beside the mesh: `otherwise`, or, where the sizes of both differ by orders of
/// magnitude, what that means: one of them is in other units.
std::string scale_hint(const TetMesh& mesh, std::span<const Vec3d> stroke, const std::string& otherwise);

} // namespace pith
