#pragma once
// The outer shape of a kiwi fruit.
#include "volume/mesh/tri_mesh.h"

namespace pith {

/// A closed surface, 50 × 46 × 62 mm: a blunt ovoid along z with a dimple at either end (the deeper one, the stem's,
/// at +z) and slow unevenness, centred near the origin. The triangles are near-uniform: about `triangles` of them
/// (within 5 %), all vertices of valence 5 to 7. The first vertex is the stem's end and the last the other end, both
/// on the z axis. Errors: InvalidInput below 100 or above 1,000,000 triangles. O(n log n): 24,000 triangles take
/// about a second.
TriMesh kiwi_surface(int triangles);

/// The radius of that surface in a direction (unit length), mm: it is star-shaped around the origin.
double kiwi_surface_radius(const Vec3d& direction);

} // namespace pith
