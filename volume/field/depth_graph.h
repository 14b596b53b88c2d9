#pragma once
// What the extrema of a region's depth are found and levelled on: its vertices and edges (private to the field
// module).
#include "volume/field/depth_extrema.h"

namespace pith {

struct DepthGraph {
  const TetMesh& mesh;
  std::vector<VertexId> vertex; ///< of the region, ascending
  VertexNeighbors neighbors;    ///< along edges of the region's tets, by the mesh's numbers
};

/// The mesh must outlive it.
DepthGraph depth_graph(const TetMesh& mesh, std::int32_t region);

/// As extrema_of in depth_extrema.h, the maxima or the minima alone; in the order in which they end.
std::vector<DepthExtremum> extrema_of(const DepthGraph& graph, const PerVertex<float>& depth,
                                      const PerVertex<std::uint8_t>& constrained, bool maxima, double persistence);

} // namespace pith
