#pragma once
// Figures of the regions of a tet mesh: how much there is of each, and how well shaped its tets are.
#include "volume/mesh/tet_mesh.h"

namespace pith {

/// The smallest of a tet's six angles between faces, radians; 0 for a flat tet. A regular tet has 1.231 (70.5°).
double smallest_dihedral(const std::array<Vec3d, 4>& corner);

struct RegionMeasure {
  std::int32_t region = 0;
  std::size_t tets = 0;
  double volume = 0; ///< mm³
  Box bounds;
  double minimum_dihedral = 0;      ///< radians, over its tets
  double outside_area = 0;          ///< mm², of its boundary with nothing behind
  double interface_area = 0;        ///< mm², of its boundary with other regions
  std::vector<std::int32_t> beside; ///< the regions that it touches with facets, ascending
};

/// One entry for each region that has tets, by ascending number. Precondition: the mesh is connected. O(n), sums in a
/// fixed order.
std::vector<RegionMeasure> measure_regions(const TetMesh& mesh);

} // namespace pith
