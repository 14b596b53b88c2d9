#pragma once
// The author of solids that are one colour all the way through: one look-up of one texel per tet.
#include "volume/layer/layer.h"
#include "volume/mesh/tet_mesh.h"

namespace pith {

/// Fills the tets of `region` (−1: all) with a colour (linear Rec.709, 0 to 1). Exact at every point to the 8 bits of
/// the texel.
Layer plain_layer(const TetMesh& mesh, std::int32_t region, const Vec3d& color, const std::string& name);

} // namespace pith
