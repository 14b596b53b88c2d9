// Volumes, areas and dihedral angles by region.
#include "volume/mesh/region_measure.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace pith {

double smallest_dihedral(const std::array<Vec3d, 4>& corner) {
  std::array<Vec3d, 4> normal;
  for (int i = 0; i < 4; ++i) {
    const auto& c = facet_corners[i];
    normal[i] = (corner[c[1]] - corner[c[0]]).cross(corner[c[2]] - corner[c[0]]);
  }
  double smallest = std::numbers::pi;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j)
      smallest = std::min(smallest, std::atan2(normal[i].cross(normal[j]).norm(), -normal[i].dot(normal[j])));
  return smallest;
}

std::vector<RegionMeasure> measure_regions(const TetMesh& mesh) {
  std::vector<double> dihedral(mesh.tet_count());
  parallel_for(mesh.tet_count(), 4096, [&](std::size_t i) {
    const auto& c = mesh.corner[TetId(i)];
    dihedral[i] =
        smallest_dihedral({mesh.position[c[0]], mesh.position[c[1]], mesh.position[c[2]], mesh.position[c[3]]});
  });
  std::map<std::int32_t, RegionMeasure> of_region;
  std::map<std::int32_t, std::set<std::int32_t>> beside;
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
    RegionMeasure& measure = of_region[mesh.region[t]];
    const auto& corner = mesh.corner[t];
    measure.minimum_dihedral = measure.tets == 0 ? dihedral[t] : std::min(measure.minimum_dihedral, dihedral[t]);
    ++measure.tets;
    measure.volume += signed_volume(mesh, t);
    for (const VertexId v : corner) measure.bounds.add(mesh.position[v]);
    for (int i = 0; i < 4; ++i) {
      const TetId behind = mesh.neighbor[t][i];
      if (behind.exists() && mesh.region[behind] == mesh.region[t]) continue;
      const auto& c = facet_corners[i];
      const Vec3d& origin = mesh.position[corner[c[0]]];
      const double area =
          0.5 * (mesh.position[corner[c[1]]] - origin).cross(mesh.position[corner[c[2]]] - origin).norm();
      if (behind.exists()) beside[mesh.region[t]].insert(mesh.region[behind]);
      (behind.exists() ? measure.interface_area : measure.outside_area) += area;
    }
  }
  std::vector<RegionMeasure> result;
  for (auto& [region, measure] : of_region) {
    measure.region = region;
    measure.beside.assign(beside[region].begin(), beside[region].end());
    result.push_back(measure);
  }
  return result;
}

} // namespace pith
