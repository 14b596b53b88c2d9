#pragma once
// Multi-face fill: the part of a boundary around a place, up to its creases (Takayama 2008, §3.2).
#include "volume/mesh/boundary.h"

#include <span>

namespace pith {

/// The facets of `region` that can be reached from the `seeds` (facets of that region) across edges at which the
/// boundary turns by at most `crease` (radians, 0 … π); ascending. Edges with more than two facets of the region stop
/// it. O(facets log facets).
std::vector<FacetId> facets_up_to_creases(const TetMesh& mesh, const Boundary& boundary, std::int32_t region,
                                          std::span<const FacetId> seeds, double crease);

} // namespace pith
