// Depth by thin-plate interpolation in 3D: Takayama, Okabe, Ijiri, Igarashi: Lapped solid textures, SIGGRAPH 2008,
// §5.2.2 (after Turk, O'Brien 1999).
//
// Departures: the paper interpolates all constraints; here centres of small models are thinned, since the skin's
// vertices crowd far closer than the smooth interpolant needs, and the vertices left out take their prescribed depths
// afterwards. And extrema that no constraint asks for are levelled, unless they are to be kept.
#include "volume/field/depth.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/field/depth_flood.h"
#include "volume/field/depth_overshoot.h"
#include "volume/field/depth_places.h"
#include "volume/field/farthest_points.h"
#include "volume/field/radial_basis.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pith {
namespace {

/// From so many places on all are centres.
constexpr std::size_t all_from = 20'000;
constexpr std::size_t few_centers = 500;
/// Places closer to an earlier one than this fraction of the diagonal are left out when all are centres.
constexpr double least_gap = 1e-4;
/// Guards against overshoots: so many rounds, and so many guards in each.
constexpr int most_rounds = 8;
constexpr std::size_t guards_at_once = 16;

struct Places {
  std::vector<Vec3d> point;
  std::vector<double> value;

  void add(const Vec3d& p, double v) {
    point.push_back(p);
    value.push_back(v);
  }
};

/// Stroke samples, then vertices with a prescribed depth, but for those too close to an earlier place.
Places all_of(const TetMesh& mesh, const DepthPlaces& places) {
  Places all;
  for (std::size_t i = 0; i < places.sample.size(); ++i) all.add(places.sample[i], places.sample_value[i]);
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count()))
    if (!std::isnan(places.prescribed[v])) all.add(mesh.position[v], places.prescribed[v]);
  Box box;
  for (const Vec3d& p : all.point) box.add(p);
  const double gap = least_gap * box.diagonal();
  std::vector<std::uint32_t> order(all.point.size()), rank(order.size());
  std::iota(order.begin(), order.end(), 0u);
  const Vec3d direction = Vec3d(0.5377, 0.6912, 0.4829).normalized(); // across no face or row that is likely
  std::vector<double> along;
  for (const Vec3d& p : all.point) along.push_back(direction.dot(p));
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(along[a], a) < std::pair(along[b], b); });
  for (std::uint32_t r = 0; r < order.size(); ++r) rank[order[r]] = r;
  Places kept;
  std::vector<std::uint8_t> stays(order.size(), 0);
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    bool free = true;
    const auto near = [&](std::uint32_t j) {
      return j < i && stays[j] && (all.point[i] - all.point[j]).squaredNorm() < gap * gap;
    };
    for (std::uint32_t r = rank[i]; free && r-- > 0 && along[i] - along[order[r]] < gap;) free = !near(order[r]);
    for (std::uint32_t r = rank[i] + 1; free && r < order.size() && along[order[r]] - along[i] < gap; ++r)
      free = !near(order[r]);
    stays[i] = free;
    if (free) kept.add(all.point[i], all.value[i]);
  }
  return kept;
}

/// At most `most` places: stroke samples first, then vertices.
Places thinned(const TetMesh& mesh, const DepthPlaces& places, std::size_t most) {
  Places candidates, result;
  for (const std::uint32_t i : farthest_points(places.sample, most / 2))
    candidates.add(places.sample[i], places.sample_value[i]);
  const std::size_t samples = candidates.point.size();
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count()))
    if (!std::isnan(places.prescribed[v])) candidates.add(mesh.position[v], places.prescribed[v]);
  for (const std::uint32_t i : farthest_points(candidates.point, most, samples))
    result.add(candidates.point[i], candidates.value[i]);
  return result;
}

/// The centres of the radial basis and their depths.
Places centers_of(const TetMesh& mesh, const DepthPlaces& places, std::size_t most) {
  std::size_t count = places.sample.size();
  for (const float prescribed : places.prescribed) count += !std::isnan(prescribed);
  if (most == 0) most = count < all_from ? few_centers : count;
  return most < count ? thinned(mesh, places, most) : all_of(mesh, places);
}

RadialBasis fit(const Places& centers) { return RadialBasis::fit(centers.point, centers.value, {.accuracy = 3e-7}); }

/// Every vertex' depth by the interpolant, where it is prescribed that.
PerVertex<float> interpolated(const TetMesh& mesh, const DepthGraph& graph, const DepthPlaces& places,
                              const RadialBasis& basis) {
  PerVertex<float> depth(mesh.vertex_count(), 0.0f);
  parallel_for(graph.vertex.size(), 256, [&](std::size_t i) {
    const VertexId v = graph.vertex[i];
    const float prescribed = places.prescribed[v];
    depth[v] = std::isnan(prescribed) ? static_cast<float>(basis.value(mesh.position[v])) : prescribed;
  });
  return depth;
}

std::vector<DepthPlace> constraints_of(const TetMesh& mesh, const DepthPlaces& places) {
  std::vector<DepthPlace> all;
  for (std::size_t i = 0; i < places.sample.size(); ++i) all.push_back({places.sample[i], places.sample_value[i]});
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count()))
    if (!std::isnan(places.prescribed[v])) all.push_back({mesh.position[v], places.prescribed[v]});
  return all;
}

/// The gradient of the linear function through a tet's corners.
Vec3d linear_gradient(const TetMesh& mesh, TetId t, const PerVertex<float>& value) {
  const auto& corner = mesh.corner[t];
  std::array<Vec3d, 3> edge;
  Vec3d rise;
  for (int k = 0; k < 3; ++k) {
    edge[k] = mesh.position[corner[k + 1]] - mesh.position[corner[0]];
    rise[k] = double(value[corner[k + 1]]) - value[corner[0]];
  }
  const auto& [a, b, c] = edge;
  const double volume = a.dot(b.cross(c));
  if (volume == 0) return Vec3d::Zero();
  return (rise[0] * b.cross(c) + rise[1] * c.cross(a) + rise[2] * a.cross(b)) / volume;
}

/// Takes levelled depths over. Where they hardly rise any more, their gradient has the slope with which they began.
void take(const TetMesh& mesh, std::int32_t region, const LevelledDepth& levelled, DepthField& field) {
  parallel_for(mesh.tet_count(), 256, [&](std::size_t i) {
    const TetId t(i);
    const auto& corner = mesh.corner[t];
    const auto moved = [&](VertexId v) { return levelled.depth[v] != field.value[v]; };
    if (mesh.region[t] != region || std::none_of(corner.begin(), corner.end(), moved)) return;
    const Vec3d gradient = linear_gradient(mesh, t, levelled.depth);
    const double rise = gradient.norm();
    field.gradient[t] = rise > 0 && rise < levelled.slope ? Vec3d(gradient * (levelled.slope / rise)) : gradient;
  });
  for (std::size_t v = 0; v < field.value.size(); ++v)
    field.value[VertexId(v)] = std::clamp(levelled.depth[VertexId(v)], 0.0f, 1.0f);
}

} // namespace

DepthField depth_field(const TetMesh& mesh, const Boundary& boundary, std::int32_t region,
                       const std::vector<DepthConstraint>& constraints, const std::string& where,
                       const DepthOptions& options) {
  if (options.max_centers != 0 && options.max_centers < 8)
    throw InvalidInput(where, "max_centers is " + std::to_string(options.max_centers),
                       "allow at least 8, or 0 for as many as are worth while");
  if (!(options.persistence >= 0))
    throw InvalidInput(where, "persistence is " + std::to_string(options.persistence), "give a depth of 0 or more");
  if (!(options.stroke_spacing >= 0) || !std::isfinite(options.stroke_spacing))
    throw InvalidInput(where, "stroke_spacing is " + std::to_string(options.stroke_spacing),
                       "give millimetres, or 0 for a fortieth of the stroke");
  const DepthPlaces places = depth_places(mesh, boundary, region, constraints, where, options);
  const PerVertex<std::uint8_t> held = held_vertices(mesh, region, places);
  const DepthGraph graph = depth_graph(mesh, region);

  Places centers = centers_of(mesh, places, static_cast<std::size_t>(options.max_centers));
  RadialBasis basis = fit(centers);
  PerVertex<float> depth = interpolated(mesh, graph, places, basis);
  if (options.guard_overshoot) {
    const std::vector<DepthPlace> constraints = constraints_of(mesh, places);
    const int rounds = centers.point.size() < all_from ? most_rounds : 2; // each is a fit
    for (int round = 0; round < rounds; ++round) {
      const auto guards = guards_of(graph, depth, held, constraints, options.persistence, guards_at_once);
      if (guards.empty()) break;
      for (const DepthPlace& guard : guards) centers.add(guard.point, guard.value);
      basis = fit(centers);
      depth = interpolated(mesh, graph, places, basis);
    }
  }

  DepthField field;
  field.centers = basis.center_count();
  field.value.assign(mesh.vertex_count(), 0.0f);
  for (const VertexId v : graph.vertex) field.value[v] = std::clamp(depth[v], 0.0f, 1.0f);
  field.gradient.assign(mesh.tet_count(), Vec3d::Zero());
  parallel_for(mesh.tet_count(), 256, [&](std::size_t i) {
    const TetId t(i);
    if (mesh.region[t] == region) field.gradient[t] = basis.gradient(barycenter(mesh, t));
  });
  for (const bool maxima : {false, true})
    field.extrema += extrema_of(graph, field.value, held, maxima, options.persistence).size();
  if (field.extrema > 0 && options.remove_extrema)
    take(mesh, region, without_extrema(graph, field.value, held, options.persistence), field);
  return field;
}

} // namespace pith
