// Gathers the places where depth is prescribed and refuses contradictions.
#include "volume/field/depth_places.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/field/face_fill.h"
#include "volume/field/scale_hint.h"
#include "volume/mesh/facet_tree.h"
#include "volume/mesh/locate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <sstream>

namespace pith {
namespace {

/// Places closer than this fraction of the region's diagonal are one place.
constexpr double same_place = 1e-6;
/// A corner with less of a barycentric coordinate is no corner of the face, edge or vertex where a point lies.
constexpr double least_part = 1e-6;
/// A stroke may lie this fraction of the diagonal outside the region (drawn on a smoother surface than the mesh's).
constexpr double stroke_margin = 0.01;

std::string text_of(const Vec3d& p) {
  std::ostringstream text;
  text << "(" << p.x() << ", " << p.y() << ", " << p.z() << ")";
  return text.str();
}

std::string text_of(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string constraint_name(const std::string& where, std::size_t index) {
  return where + "[" + std::to_string(index) + "]";
}

[[noreturn]] void refuse_contradiction(const std::string& where, double a, double b, const Vec3d& place) {
  throw InvalidInput(where,
                     "two constraints ask for depths " + text_of(a) + " and " + text_of(b) + " at " + text_of(place),
                     "keep places of different depth apart (shorten the stroke, or choose other triangles)");
}

/// A facet whose corners are constrained as one.
struct Held {
  std::array<Vec3d, 3> corner;
  double value;
};

bool meet(const Vec3d& a, const Vec3d& b, const std::array<Vec3d, 3>& t) {
  const auto volume = [](const Vec3d& p, const Vec3d& q, const Vec3d& r, const Vec3d& s) {
    return (q - p).cross(r - p).dot(s - p);
  };
  const double side_a = volume(t[0], t[1], t[2], a), side_b = volume(t[0], t[1], t[2], b);
  if (side_a * side_b > 0 || (side_a == 0 && side_b == 0)) return false;
  const double u = volume(a, b, t[0], t[1]), v = volume(a, b, t[1], t[2]), w = volume(a, b, t[2], t[0]);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

struct Gathering {
  const TetMesh& mesh;
  const Boundary& boundary;
  std::int32_t region;
  const std::string& where;
  double diagonal = 0;
  DepthPlaces places;
  std::vector<Held> held;
  PerVertex<std::uint8_t> by_part = {}; ///< 1: held by the outside or an interface alone; 2: a rim of two such parts

  void hold_facet(FacetId facet, double value, bool part = false) {
    Held h{.corner = {}, .value = value};
    by_part.resize(mesh.vertex_count(), 0);
    for (int k = 0; k < 3; ++k) {
      const VertexId v = boundary.corner[facet][k];
      float& prescribed = places.prescribed[v];
      h.corner[k] = mesh.position[v];
      if (!std::isnan(prescribed) && prescribed != static_cast<float>(value)) {
        if (!part || by_part[v] == 0) refuse_contradiction(where, prescribed, value, mesh.position[v]);
        by_part[v] = 2;
        continue;
      }
      if (std::isnan(prescribed)) by_part[v] = part;
      prescribed = static_cast<float>(value);
    }
    held.push_back(h);
  }

  void hold_skin(double value) {
    for (const FacetId f : all_ids<FacetId>(boundary.facet_count()))
      if (mesh.region[boundary.tet[f]] == region) hold_facet(f, value);
  }

  /// The facets with nothing behind (no `beyond`), or with that region behind.
  void hold_part(std::optional<std::int32_t> beyond, double value, const std::string& name) {
    std::size_t found = 0;
    for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) {
      if (mesh.region[boundary.tet[f]] != region) continue;
      const TetId behind = boundary.behind[f];
      if (beyond ? !behind.exists() || mesh.region[behind] != *beyond : behind.exists()) continue;
      hold_facet(f, value, true);
      ++found;
    }
    if (found > 0) return;
    if (!beyond)
      throw InvalidInput(name,
                         "region " + std::to_string(region) + " has no outside: other regions lie all around it",
                         "name an interface instead");
    throw InvalidInput(name, "region " + std::to_string(region) + " does not touch region " + std::to_string(*beyond),
                       "name a region that lies beside it (pith info lists them)");
  }

  void free_rims() {
    for (std::size_t v = 0; v < by_part.size(); ++v)
      if (by_part[VertexId(v)] == 2) places.prescribed[VertexId(v)] = std::numeric_limits<float>::quiet_NaN();
  }

  void hold_triangles(const std::vector<TriangleId>& triangles, double value, const std::string& name) {
    if (boundary.input.empty())
      throw InvalidInput(name, "the mesh does not know the input triangles of its facets",
                         "use the skin or strokes for this mesh");
    std::vector<TriangleId> wanted = triangles;
    std::sort(wanted.begin(), wanted.end());
    const TriangleId last = *std::max_element(boundary.input.begin(), boundary.input.end());
    if (!wanted.empty() && wanted.back() > last)
      throw InvalidInput(name,
                         "triangle " + std::to_string(wanted.back()) +
                             " is named, but the last one that bounds the " + "mesh is " + std::to_string(last),
                         "count the triangles of the surface's file from 0");
    std::size_t found = 0;
    for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) {
      if (mesh.region[boundary.tet[f]] != region) continue;
      if (!std::binary_search(wanted.begin(), wanted.end(), boundary.input[f])) continue;
      hold_facet(f, value);
      ++found;
    }
    if (found == 0)
      throw InvalidInput(
          name, "none of its " + std::to_string(wanted.size()) + " triangles bounds region " + std::to_string(region),
          "name triangles of the surface around this region");
  }

  void hold_fill(const FaceFill& fill, double value, const std::string& name) {
    if (!(fill.crease >= 0 && fill.crease <= M_PI))
      throw InvalidInput(name, "the crease is " + text_of(fill.crease), "give radians from 0 to pi");
    std::vector<FacetId> seeds;
    if (fill.triangle.exists()) {
      if (boundary.input.empty())
        throw InvalidInput(name, "the mesh does not know the input triangles of its facets",
                           "start the fill at a point");
      for (const FacetId f : all_ids<FacetId>(boundary.facet_count()))
        if (mesh.region[boundary.tet[f]] == region && boundary.input[f] == fill.triangle) seeds.push_back(f);
      if (seeds.empty())
        throw InvalidInput(name,
                           "triangle " + std::to_string(fill.triangle.value) + " bounds no part of region " +
                               std::to_string(region),
                           "name a triangle of the surface around this region");
    } else {
      double least = std::numeric_limits<double>::infinity();
      FacetId nearest;
      for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) {
        if (mesh.region[boundary.tet[f]] != region) continue;
        std::array<Vec3d, 3> corner;
        for (int k = 0; k < 3; ++k) corner[k] = mesh.position[boundary.corner[f][k]];
        const double distance = closest_point(corner, fill.near).squared_distance;
        if (distance < least) {
          least = distance;
          nearest = f;
        }
      }
      if (!(std::sqrt(least) <= stroke_margin * diagonal))
        throw InvalidInput(name,
                           "the fill starts at " + text_of(fill.near) + ", " + text_of(std::sqrt(least)) +
                               " mm from the boundary of region " + std::to_string(region),
                           "give a point on the surface, in the mesh's millimetres");
      seeds.push_back(nearest);
    }
    for (const FacetId f : facets_up_to_creases(mesh, boundary, region, seeds, fill.crease)) hold_facet(f, value);
  }

  void hold_stroke(std::span<const Vec3d> stroke, double value, double spacing, const std::string& name) {
    for (const Vec3d& p : stroke)
      if (!p.allFinite()) throw InvalidInput(name, "a stroke point is not finite", "give finite coordinates");
    const double length = length_of(stroke);
    const std::vector<PolylineSample> samples = evenly_sampled(stroke, spacing > 0 ? spacing : length / 40);
    std::vector<Vec3d> point;
    for (const PolylineSample& s : samples) point.push_back(s.point);
    const std::vector<std::uint8_t> near = near_region(mesh, region, point, stroke_margin * diagonal);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < point.size(); ++i) {
      if (!near[i]) continue;
      ++kept;
      places.sample.push_back(point[i]);
      places.sample_value.push_back(value);
    }
    if (kept == 0)
      throw InvalidInput(name,
                         "the stroke from " + text_of(stroke.front()) + " to " + text_of(stroke.back()) +
                             " misses region " + std::to_string(region),
                         scale_hint(mesh, stroke, "draw it on or inside the region, in the mesh's millimetres"));
  }
};

/// A stroke must not meet a facet or a stroke of another depth.
void check_strokes(const Gathering& gathering, const std::vector<DepthConstraint>& constraints) {
  const double reach = same_place * gathering.diagonal;
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    const std::vector<Vec3d>& stroke = constraints[c].stroke;
    const double value = constraints[c].value;
    for (std::size_t i = 0; i < stroke.size(); ++i) {
      const Vec3d &a = stroke[i], &b = stroke[std::min(i + 1, stroke.size() - 1)];
      Box box;
      box.add(a);
      box.add(b);
      box.low.array() -= reach;
      box.high.array() += reach;
      for (const Held& held : gathering.held) {
        if (held.value == value) continue;
        Box other;
        for (const Vec3d& p : held.corner) other.add(p);
        if ((other.low.array() > box.high.array()).any() || (other.high.array() < box.low.array()).any()) continue;
        if (closest_point(held.corner, a).squared_distance <= reach * reach || meet(a, b, held.corner))
          refuse_contradiction(gathering.where, held.value, value, a);
      }
      for (std::size_t d = 0; d < constraints.size(); ++d) {
        const std::vector<Vec3d>& against = constraints[d].stroke;
        if (constraints[d].value == value) continue;
        for (std::size_t j = 0; j < against.size(); ++j)
          if (squared_distance(a, against[j], against[std::min(j + 1, against.size() - 1)]) <= reach * reach)
            refuse_contradiction(gathering.where, constraints[d].value, value, a);
      }
    }
  }
}

/// Vertices on a stroke take its depth too.
void hold_vertices_on_strokes(Gathering& gathering, const std::vector<DepthConstraint>& constraints) {
  const double reach = 1e-9 * gathering.diagonal;
  for (const DepthConstraint& constraint : constraints) {
    if (constraint.stroke.empty()) continue;
    const auto& stroke = constraint.stroke;
    Box box;
    for (const Vec3d& p : stroke) box.add(p);
    box.low.array() -= reach;
    box.high.array() += reach;
    parallel_for(gathering.mesh.vertex_count(), 4096, [&](std::size_t v) {
      const Vec3d& x = gathering.mesh.position[VertexId(v)];
      if (!box.contains(x)) return;
      for (std::size_t i = 0; i < stroke.size(); ++i)
        if (squared_distance(x, stroke[i], stroke[std::min(i + 1, stroke.size() - 1)]) <= reach * reach)
          gathering.places.prescribed[VertexId(v)] = static_cast<float>(constraint.value);
    });
  }
}

} // namespace

DepthPlaces depth_places(const TetMesh& mesh, const Boundary& boundary, std::int32_t region,
                         const std::vector<DepthConstraint>& constraints, const std::string& where,
                         const DepthOptions& options) {
  Gathering gathering{.mesh = mesh, .boundary = boundary, .region = region, .where = where, .places = {}, .held = {}};
  Box box;
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    if (mesh.region[t] == region)
      for (const VertexId v : mesh.corner[t]) box.add(mesh.position[v]);
  if (box.empty())
    throw InvalidInput(where, "the mesh has no region " + std::to_string(region),
                       "name a region from 0 on (one per closed shell of the surface)");
  gathering.diagonal = box.diagonal();
  gathering.places.prescribed.assign(mesh.vertex_count(), std::numeric_limits<float>::quiet_NaN());

  if (constraints.empty())
    throw InvalidInput(where, "there is no depth constraint",
                       "give at least two places, such as the skin with depth 0 and a stroke with depth 1");
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    const DepthConstraint& constraint = constraints[c];
    const std::string name = constraint_name(where, c);
    if (!(constraint.value >= 0 && constraint.value <= 1))
      throw InvalidInput(name, "depth " + text_of(constraint.value) + " lies outside [0, 1]",
                         "use 0 for the outermost and 1 for the innermost part");
    if (!constraint.skin && !constraint.outside && !constraint.interface && constraint.triangles.empty() &&
        constraint.stroke.empty() && !constraint.fill)
      throw InvalidInput(name, "the constraint names no place",
                         "give it the skin, the outside, an interface, triangles, a fill or a stroke");
    if (constraint.skin) gathering.hold_skin(constraint.value);
    if (constraint.outside) gathering.hold_part({}, constraint.value, name);
    if (constraint.interface) gathering.hold_part(constraint.interface, constraint.value, name);
    if (!constraint.triangles.empty()) gathering.hold_triangles(constraint.triangles, constraint.value, name);
    if (constraint.fill) gathering.hold_fill(*constraint.fill, constraint.value, name);
    if (!constraint.stroke.empty())
      gathering.hold_stroke(constraint.stroke, constraint.value, options.stroke_spacing, name);
  }
  const bool varied = std::any_of(constraints.begin(), constraints.end(),
                                  [&](const DepthConstraint& c) { return c.value != constraints[0].value; });
  if (!varied)
    throw InvalidInput(where,
                       "all " + std::to_string(constraints.size()) + " depth constraints have the value " +
                           text_of(constraints[0].value),
                       "give a second place another depth, such as 1 at the core");
  gathering.free_rims();
  check_strokes(gathering, constraints);
  hold_vertices_on_strokes(gathering, constraints);
  return std::move(gathering.places);
}

PerVertex<std::uint8_t> held_vertices(const TetMesh& mesh, std::int32_t region, const DepthPlaces& places) {
  PerVertex<std::uint8_t> held(mesh.vertex_count(), 0);
  std::vector<std::uint8_t> used(mesh.vertex_count(), 0);
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    if (mesh.region[t] == region)
      for (const VertexId v : mesh.corner[t]) used[v] = 1;
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count())) held[v] = !std::isnan(places.prescribed[v]);
  std::vector<std::uint32_t> nearest(places.sample.size());
  parallel_for(places.sample.size(), 4, [&](std::size_t s) {
    double least = std::numeric_limits<double>::infinity();
    for (const VertexId v : all_ids<VertexId>(mesh.vertex_count())) {
      if (!used[v]) continue;
      const double distance = (mesh.position[v] - places.sample[s]).squaredNorm();
      if (distance < least) {
        least = distance;
        nearest[s] = v;
      }
    }
  });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> by_vertex; // nearest vertex, sample
  for (std::size_t s = 0; s < nearest.size(); ++s) {
    held[VertexId(nearest[s])] = 1;
    by_vertex.emplace_back(nearest[s], static_cast<std::uint32_t>(s));
  }
  std::sort(by_vertex.begin(), by_vertex.end());
  const auto sampled = [&](VertexId v) {
    return std::equal_range(by_vertex.begin(), by_vertex.end(), std::pair(v.value, 0u),
                            [](const auto& a, const auto& b) { return a.first < b.first; });
  };
  const PerVertex<std::uint8_t> around = held; // the loop below adds to `held`
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
    if (mesh.region[t] != region) continue;
    for (const VertexId v : mesh.corner[t]) {
      if (!around[v]) continue;
      const auto [first, last] = sampled(v);
      for (auto entry = first; entry != last; ++entry) {
        const std::array<double, 4> part = barycentric(mesh, t, places.sample[entry->second]);
        if (*std::min_element(part.begin(), part.end()) < -least_part) continue;
        for (int k = 0; k < 4; ++k)
          if (part[k] > least_part) held[mesh.corner[t][k]] = 1;
      }
    }
  }
  return held;
}

} // namespace pith
