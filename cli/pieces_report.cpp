#include "cli/pieces_report.h"

#include "volume/base/disjoint_sets.h"

#include <algorithm>

namespace pith::cli {
namespace {

/// One of a triangle's three sides, by its vertices in ascending order.
struct Side {
  std::uint32_t a, b, triangle;
  auto operator<=>(const Side&) const = default;
};

} // namespace

PieceReport report_of(const Pieces& pieces, std::uint32_t piece, const Model& model) {
  const PieceMeasure measured = measure(pieces, piece, model.mesh);
  const PieceSurface surface = surface_of(pieces, piece, model.mesh, model.boundary);
  PieceReport report{.volume = measured.volume,
                     .centroid = measured.centroid,
                     .bounds = measured.bounds,
                     .whole_tets = measured.whole_tets,
                     .cut_tets = measured.cut_tets,
                     .triangles = surface.triangle.size(),
                     .minimum_dihedral = measured.minimum_dihedral};

  std::vector<Side> side;
  side.reserve(3 * surface.triangle.size());
  for (std::uint32_t t = 0; t < surface.triangle.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = surface.triangle[t].corner[k], b = surface.triangle[t].corner[(k + 1) % 3];
      side.push_back({std::min(a, b), std::max(a, b), t});
    }
  std::sort(side.begin(), side.end());

  // Corners of triangles (3t + k) that stand on one vertex are joined across shared edges: one fan is one set.
  DisjointSets corners(3 * surface.triangle.size());
  const auto corner_at = [&](std::uint32_t t, std::uint32_t vertex) {
    const auto& corner = surface.triangle[t].corner;
    return 3 * t + (corner[0] == vertex ? 0u : corner[1] == vertex ? 1u : 2u);
  };
  for (std::size_t begin = 0; begin < side.size();) {
    std::size_t end = begin;
    while (end < side.size() && side[end].a == side[begin].a && side[end].b == side[begin].b) ++end;
    if ((end - begin) % 2 == 1) ++report.border_edges;
    if (end - begin > 2) ++report.non_manifold_edges;
    for (std::size_t i = begin + 1; i < end; ++i)
      for (const std::uint32_t vertex : {side[begin].a, side[begin].b})
        corners.join(corner_at(side[i].triangle, vertex), corner_at(side[begin].triangle, vertex));
    begin = end;
  }
  std::vector<std::uint32_t> fans(surface.vertex.size(), 0);
  for (std::uint32_t t = 0; t < surface.triangle.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k)
      if (corners.representative(3 * t + k) == 3 * t + k) ++fans[surface.triangle[t].corner[k]];
  report.non_manifold_vertices =
      static_cast<std::size_t>(std::count_if(fans.begin(), fans.end(), [](std::uint32_t n) { return n > 1; }));
  return report;
}

} // namespace pith::cli
