// A cut by depth: the field is known at the root's vertices and linear on its tets, so its section is exact.
#include "recipe/steps.h"
#include "volume/base/error.h"

#include <algorithm>
#include <limits>

namespace pith {

std::vector<double> depth_values(const Pieces& pieces, const Model& model, const DepthCut& cut,
                                 const std::string& where) {
  const TetMesh& root = model.mesh;
  if (model.field.depth.size() != root.vertex_count())
    throw InvalidInput(where, "the model has no depth",
                       "cut by depth where a solid has one: its \"depth\" in the recipe");
  constexpr double unknown = std::numeric_limits<double>::infinity();
  std::vector<double> value(root.vertex_count(), unknown);
  bool found = false;
  for (const TetId t : all_ids<TetId>(root.tet_count())) {
    if (root.region[t] != cut.region) continue;
    found = true;
    for (const VertexId v : root.corner[t]) value[v] = model.field.depth[v] - cut.value;
  }
  if (!found) throw InvalidInput(where, "there is no region " + std::to_string(cut.region), "name one that exists");

  // Outwards from the region, in rounds: the mean of the neighbours that the rounds before reached.
  const VertexNeighbors neighbors = vertices_around_vertices(root);
  std::vector<VertexId> open;
  for (const VertexId v : all_ids<VertexId>(root.vertex_count()))
    if (value[v] == unknown) open.push_back(v);
  while (!open.empty()) {
    std::vector<std::pair<VertexId, double>> reached;
    std::vector<VertexId> still;
    for (const VertexId v : open) {
      double sum = 0;
      int count = 0;
      for (const VertexId w : neighbors[v])
        if (value[w] != unknown) sum += value[w], ++count;
      if (count > 0)
        reached.emplace_back(v, sum / count);
      else
        still.push_back(v);
    }
    for (const auto& [v, x] : reached) value[v] = x;
    if (reached.empty()) { // a part of the solid that does not touch the region: inside
      for (const VertexId v : still) value[v] = 1 - cut.value;
      still.clear();
    }
    open = std::move(still);
  }
  value.reserve(root.vertex_count() + pieces.added.size());
  for (std::size_t i = 0; i < pieces.added.size(); ++i) {
    const auto& [a, b, by] = pieces.added[i];
    const Vec3d &from = pieces.position(root, a), along = pieces.position(root, b) - from;
    const double t = (pieces.added_position[i] - from).dot(along) / along.squaredNorm();
    value.push_back(value[a] + t * (value[b] - value[a]));
  }
  return value;
}

} // namespace pith
