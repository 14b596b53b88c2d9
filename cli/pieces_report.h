#pragma once
// What can be said about the pieces of a model: shared by `info` and `check`.
#include "volume/cut/piece.h"
#include "volume/layer/model.h"

namespace pith::cli {

struct PieceReport {
  double volume = 0;              ///< mm³
  Vec3d centroid = Vec3d::Zero(); ///< rest space
  Box bounds;                     ///< rest space
  std::size_t whole_tets = 0, cut_tets = 0, triangles = 0;
  std::size_t border_edges = 0;          ///< edges of the surface with an odd number of triangles
  std::size_t non_manifold_edges = 0;    ///< edges with more than two triangles
  std::size_t non_manifold_vertices = 0; ///< vertices whose triangles form more than one fan
  double minimum_dihedral = 0;           ///< radians, over cut tets
  bool watertight() const { return border_edges == 0; }
  bool manifold() const { return border_edges + non_manifold_edges + non_manifold_vertices == 0; }
};

/// O(n log n) in the piece's surface.
PieceReport report_of(const Pieces& pieces, std::uint32_t piece, const Model& model);

} // namespace pith::cli
