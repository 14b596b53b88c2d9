#pragma once
// Takes spurious extrema out of a depth field (private to the field module).
#include "volume/mesh/tet_mesh.h"

namespace pith {

/// The field near `depth` in which every vertex of the region but the fixed ones has a higher and a lower neighbour,
/// wherever the harmonic field between the fixed depths rises at all. Where `depth` is so already it stays nearly as
/// it is. Fixed vertices keep their depths; vertices of other regions are passed over.
/// Cost: O(n log n): one multigrid solution and a few sweeps. The same bits on any number of threads.
/// Errors: SolverFailure when the harmonic field does not converge.
PerVertex<float> monotone_depth(const TetMesh& mesh, std::int32_t region, const PerVertex<float>& depth,
                                const PerVertex<std::uint8_t>& fixed);

} // namespace pith
