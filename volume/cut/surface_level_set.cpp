// Signed distance to a triangle mesh, by angle-weighted pseudonormals: Bærentzen, Aanæs: Signed distance computation
// using the angle weighted pseudonormal, 2005, §4. For a closed surface the sign is that of inside and outside;
// beyond the rim of an open one it is that of the tangent plane at the rim.
#include "volume/cut/level_set.h"

#include "volume/base/error.h"
#include "volume/mesh/facet_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace pith {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;
Edge edge_of(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

class SurfaceLevelSet final : public LevelSet {
public:
  explicit SurfaceLevelSet(const TriMesh& surface) : corner_(surface.corner) {
    std::vector<std::array<Vec3d, 3>> triangles;
    vertex_normal_.assign(surface.vertex_count(), Vec3d::Zero());
    for (const TriangleId t : all_ids<TriangleId>(surface.triangle_count())) {
      const auto& c = corner_[t];
      const std::array<Vec3d, 3> p = {surface.position[c[0]], surface.position[c[1]], surface.position[c[2]]};
      triangles.push_back(p);
      const Vec3d area = (p[1] - p[0]).cross(p[2] - p[0]);
      const double length = area.norm();
      normal_.push_back(length > 0 ? Vec3d(area / length) : Vec3d::Zero());
      for (int i = 0; i < 3; ++i) {
        const Vec3d to_next = p[(i + 1) % 3] - p[i], to_last = p[(i + 2) % 3] - p[i];
        const double angle = std::atan2(to_next.cross(to_last).norm(), to_next.dot(to_last));
        vertex_normal_[c[i]] += angle * normal_.back();
        edge_normal_.try_emplace(edge_of(c[i], c[(i + 1) % 3]), Vec3d::Zero()).first->second += normal_.back();
      }
    }
    tree_ = FacetTree(std::move(triangles));
    std::map<Edge, std::array<int, 2>> uses; // of each edge, in its two directions
    for (const auto& c : corner_)
      for (int i = 0; i < 3; ++i) ++uses[edge_of(c[i], c[(i + 1) % 3])][c[i] < c[(i + 1) % 3]];
    closed_ = std::all_of(uses.begin(), uses.end(), [](const auto& use) { return use.second[0] == use.second[1]; });
  }

  /// Beyond the rim of an open surface the value jumps, so nothing is certain there.
  int side_of_ball(const Vec3d& center, double radius) const override {
    if (!closed_) return 0;
    const double at = value(center), reach = radius + 1e-9 * (radius + std::abs(at));
    return (at > reach) - (at < -reach);
  }

  double value(const Vec3d& x) const override {
    const NearestFacet nearest = tree_.nearest(x);
    return std::sqrt(nearest.squared_distance) * side(x, nearest);
  }

  Vec3d gradient(const Vec3d& x) const override {
    const NearestFacet nearest = tree_.nearest(x);
    const Vec3d from = x - nearest.point;
    const double distance = from.norm();
    return distance > 1e-9 * (1 + x.norm()) ? Vec3d(side(x, nearest) / distance * from) : pseudonormal(nearest);
  }

private:
  double side(const Vec3d& x, const NearestFacet& nearest) const {
    return (x - nearest.point).dot(pseudonormal(nearest)) < 0 ? -1 : 1;
  }

  /// Of the face, edge or vertex that holds the nearest point.
  Vec3d pseudonormal(const NearestFacet& nearest) const {
    const auto& c = corner_[TriangleId(nearest.facet)];
    const auto& b = nearest.barycentric;
    for (int i = 0; i < 3; ++i)
      if (b[(i + 1) % 3] == 0 && b[(i + 2) % 3] == 0) return vertex_normal_[c[i]];
    for (int i = 0; i < 3; ++i)
      if (b[i] == 0) return edge_normal_.at(edge_of(c[(i + 1) % 3], c[(i + 2) % 3]));
    return normal_[TriangleId(nearest.facet)];
  }

  PerTriangle<std::array<VertexId, 3>> corner_;
  PerTriangle<Vec3d> normal_;
  PerVertex<Vec3d> vertex_normal_;
  std::map<Edge, Vec3d> edge_normal_;
  FacetTree tree_;
  bool closed_ = false;
};

} // namespace

std::unique_ptr<LevelSet> level_set_of(const TriMesh& surface, const std::string& where) {
  if (surface.triangle_count() == 0) throw InvalidInput(where, "has no triangles", "give a surface with triangles");
  for (const Vec3d& p : surface.position)
    if (!p.allFinite()) throw InvalidInput(where, "has a vertex that is not finite", "repair the file");
  for (const auto& corner : surface.corner)
    for (const VertexId v : corner)
      if (v.value >= surface.vertex_count())
        throw InvalidInput(where,
                           "names vertex " + std::to_string(v) + " of " + std::to_string(surface.vertex_count()),
                           "repair the file");
  return std::make_unique<SurfaceLevelSet>(surface);
}

} // namespace pith
