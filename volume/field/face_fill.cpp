#include "volume/field/face_fill.h"

#include <algorithm>
#include <cmath>

namespace pith {
namespace {

struct Edge {
  std::uint32_t low, high;
  FacetId facet;

  bool same(const Edge& other) const { return low == other.low && high == other.high; }
};

Vec3d normal_of(const TetMesh& mesh, const Boundary& boundary, FacetId f) {
  const auto& corner = boundary.corner[f];
  const Vec3d& a = mesh.position[corner[0]];
  return (mesh.position[corner[1]] - a).cross(mesh.position[corner[2]] - a);
}

} // namespace

std::vector<FacetId> facets_up_to_creases(const TetMesh& mesh, const Boundary& boundary, std::int32_t region,
                                          std::span<const FacetId> seeds, double crease) {
  std::vector<Edge> edges;
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count()))
    if (mesh.region[boundary.tet[f]] == region)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = boundary.corner[f][k], b = boundary.corner[f][(k + 1) % 3];
        edges.push_back({std::min(a, b), std::max(a, b), f});
      }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tuple(a.low, a.high, a.facet.value) < std::tuple(b.low, b.high, b.facet.value);
  });
  PerFacet<std::array<FacetId, 3>> beside(boundary.facet_count());
  PerFacet<std::uint8_t> count(boundary.facet_count(), 0);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].same(edges[i])) ++end;
    if (end == i + 2) {
      const FacetId f = edges[i].facet, g = edges[i + 1].facet;
      const Vec3d a = normal_of(mesh, boundary, f), b = normal_of(mesh, boundary, g);
      if (std::atan2(a.cross(b).norm(), a.dot(b)) <= crease) {
        beside[f][count[f]++] = g;
        beside[g][count[g]++] = f;
      }
    }
    i = end;
  }
  PerFacet<std::uint8_t> reached(boundary.facet_count(), 0);
  std::vector<FacetId> result;
  for (const FacetId f : seeds)
    if (!reached[f]) {
      reached[f] = 1;
      result.push_back(f);
    }
  for (std::size_t at = 0; at < result.size(); ++at)
    for (std::uint8_t k = 0; k < count[result[at]]; ++k) {
      const FacetId next = beside[result[at]][k];
      if (reached[next]) continue;
      reached[next] = 1;
      result.push_back(next);
    }
  std::sort(result.begin(), result.end(), [](FacetId a, FacetId b) { return a.value < b.value; });
  return result;
}

} // namespace pith
