// Extrema by the merging of superlevel sets: Edelsbrunner, Letscher, Zomorodian: Topological persistence and
// simplification, 2002, in dimension 0.
#include "volume/field/depth_graph.h"

#include "volume/base/error.h"
#include "volume/field/depth_places.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pith {

DepthGraph depth_graph(const TetMesh& mesh, std::int32_t region) {
  TetMesh part;
  part.position.resize(mesh.vertex_count());
  std::vector<std::uint8_t> used(mesh.vertex_count(), 0);
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    if (mesh.region[t] == region) {
      part.corner.push_back(mesh.corner[t]);
      for (const VertexId v : mesh.corner[t]) used[v] = 1;
    }
  DepthGraph graph{.mesh = mesh, .vertex = {}, .neighbors = vertices_around_vertices(part)};
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) graph.vertex.emplace_back(v);
  return graph;
}

std::vector<DepthExtremum> extrema_of(const DepthGraph& graph, const PerVertex<float>& depth,
                                      const PerVertex<std::uint8_t>& constrained, bool maxima, double persistence) {
  const TetMesh& mesh = graph.mesh;
  std::vector<DepthExtremum> result;
  const auto height = [&](VertexId v) { return maxima ? depth[v] : -depth[v]; };
  std::vector<VertexId> order = graph.vertex;
  std::sort(order.begin(), order.end(), [&](VertexId a, VertexId b) {
    return height(a) != height(b) ? height(a) > height(b) : a.value < b.value;
  });
  // Components of the part above the current height: their top, and whether a constraint holds a part of them.
  constexpr std::uint32_t absent = ~0u;
  std::vector<std::uint32_t> parent(mesh.vertex_count(), absent);
  std::vector<VertexId> top(mesh.vertex_count());
  std::vector<std::uint8_t> held(mesh.vertex_count(), 0);
  const auto root_of = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  const auto end = [&](std::uint32_t component, double at, VertexId saddle) {
    const VertexId v = top[component];
    const double lasted = height(v) - at;
    if (lasted >= persistence && lasted > 0)
      result.push_back({.vertex = v,
                        .saddle = saddle,
                        .place = mesh.position[v],
                        .maximum = maxima,
                        .depth = depth[v],
                        .persistence = lasted});
  };
  for (const VertexId v : order) {
    parent[v] = v;
    top[v] = v;
    held[v] = constrained[v];
    for (const VertexId n : graph.neighbors[v]) {
      if (parent[n] == absent) continue;
      std::uint32_t a = root_of(v), b = root_of(n);
      if (a == b) continue;
      // a goes on, b ends: what is held outlasts what is not, then the higher, then the lower number.
      const auto rank = [&](std::uint32_t c) { return std::tuple(!held[c], -height(top[c]), top[c].value); };
      if (rank(b) < rank(a)) std::swap(a, b);
      if (!held[b]) end(b, height(v), v);
      parent[b] = a;
      held[a] = held[a] || held[b];
    }
  }
  for (const VertexId v : graph.vertex)
    if (parent[v] == v && !held[v]) end(v, height(order.back()), {}); // a part that nothing constrains
  return result;
}

std::vector<DepthExtremum> extrema_of(const TetMesh& mesh, std::int32_t region, const PerVertex<float>& depth,
                                      const PerVertex<std::uint8_t>& constrained, double persistence) {
  if (depth.size() != mesh.vertex_count() || constrained.size() != mesh.vertex_count())
    throw InvalidInput("depth extrema",
                       std::to_string(depth.size()) + " depths and " + std::to_string(constrained.size()) +
                           " marks are given for " + std::to_string(mesh.vertex_count()) + " vertices",
                       "give one of each to every vertex");
  const DepthGraph graph = depth_graph(mesh, region);
  std::vector<DepthExtremum> result = extrema_of(graph, depth, constrained, true, persistence);
  const std::vector<DepthExtremum> minima = extrema_of(graph, depth, constrained, false, persistence);
  result.insert(result.end(), minima.begin(), minima.end());
  std::sort(result.begin(), result.end(), [](const DepthExtremum& a, const DepthExtremum& b) {
    return a.persistence != b.persistence ? a.persistence > b.persistence : a.vertex.value < b.vertex.value;
  });
  return result;
}

PerVertex<std::uint8_t> constrained_vertices(const TetMesh& mesh, const Boundary& boundary, std::int32_t region,
                                             const std::vector<DepthConstraint>& constraints,
                                             const std::string& where, const DepthOptions& options) {
  return held_vertices(mesh, region, depth_places(mesh, boundary, region, constraints, where, options));
}

} // namespace pith
