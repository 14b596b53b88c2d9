#include "volume/cut/displace.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/mesh/facet_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

namespace pith {

namespace {

constexpr std::uint32_t none = 0xffffffffu;
constexpr double default_edges = 400; ///< along the longest extent
constexpr double least_rise = 2e-6;   ///< of the longest extent: lower walls would have no area in a file
constexpr float same_normal = 0.999f; ///< cosine: two faces are one smooth surface at a corner

class Displacer {
public:
  Displacer(std::vector<Vec3d> rest, std::vector<SurfaceFace> face, const TetMesh& mesh, const Boundary& boundary)
      : mesh_(mesh), boundary_(boundary) {
    result_.rest = std::move(rest);
    result_.face = std::move(face);
  }

  DisplacedSurface run(const ReliefFunction& height, const DisplaceOptions& options) {
    const double extent = bounds_of(mesh_).extent().maxCoeff();
    const double max_edge = options.max_edge > 0 ? options.max_edge : extent / default_edges;
    subdivide(
        result_.rest, result_.face, max_edge, options.max_triangles,
        [&](const SurfaceFace& face) { return is_skin(face); }, "displacement_edge");
    find_points();
    move(height, options.scale, least_rise * extent);
    attach();
    set_normals();
    return std::move(result_);
  }

private:
  bool is_skin(const SurfaceFace& face) const {
    return face.tag.is_skin() && !boundary_.behind[face.tag.facet()].exists();
  }

  /// Which points the skin has, on which facet (the lowest), and which of them something else has, too.
  void find_points() {
    facet_.assign(result_.rest.size(), FacetId());
    rim_.assign(result_.rest.size(), 0);
    for (const SurfaceFace& face : result_.face)
      for (const std::uint32_t p : face.point) {
        if (!is_skin(face))
          rim_[p] = 1;
        else if (!facet_[p].exists() || face.tag.facet() < facet_[p])
          facet_[p] = face.tag.facet();
      }
  }

  void move(const ReliefFunction& height, double scale, double least) {
    const PerVertex<Vec3d> normal = skin_normals(mesh_, boundary_);
    const std::size_t count = result_.rest.size();
    result_.position = result_.rest;
    parallel_for(count, 256, [&](std::size_t p) {
      if (!facet_[p].exists()) return;
      const auto& corner = boundary_.corner[facet_[p]];
      const Vec3d& x = result_.rest[p];
      const NearestFacet at =
          closest_point({mesh_.position[corner[0]], mesh_.position[corner[1]], mesh_.position[corner[2]]}, x);
      Vec3d outwards = Vec3d::Zero();
      for (int i = 0; i < 3; ++i) outwards += at.barycentric[i] * normal[corner[i]];
      const double length = outwards.norm();
      if (!(length > 0)) return; // the skin is folded flat there
      const double rise = scale * height(x, facet_[p], boundary_.tet[facet_[p]]);
      if (rise >= least) result_.position[p] = x + rise / length * outwards;
    });
    twin_.assign(count, none);
    for (std::size_t p = 0; p < count; ++p) {
      if (!rim_[p] || result_.position[p] == result_.rest[p]) continue;
      twin_[p] = static_cast<std::uint32_t>(result_.position.size());
      result_.position.push_back(result_.position[p]);
      result_.position[p] = result_.rest[p];
      result_.rest.push_back(result_.rest[p]);
    }
  }

  std::uint32_t on_skin(std::uint32_t point) const { return twin_[point] == none ? point : twin_[point]; }

  /// Hangs the skin on its moved points, and walls between them and those that stayed.
  void attach() {
    using Edge = std::pair<std::uint32_t, std::uint32_t>;
    std::vector<Edge> fixed; // as their faces run along them
    for (const SurfaceFace& face : result_.face) {
      if (is_skin(face)) continue;
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t a = face.point[i], b = face.point[(i + 1) % 3];
        if (twin_[a] != none || twin_[b] != none) fixed.emplace_back(a, b);
      }
    }
    std::sort(fixed.begin(), fixed.end());
    std::vector<SurfaceFace> wall;
    for (SurfaceFace& face : result_.face) {
      if (!is_skin(face)) continue;
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t a = face.point[i], b = face.point[(i + 1) % 3];
        if (!std::binary_search(fixed.begin(), fixed.end(), Edge(b, a))) continue;
        const auto add = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r) {
          wall.push_back({{p, q, r}, flat_normals({p, q, r}), face.root, face.tag});
        };
        if (twin_[b] != none) add(a, b, twin_[b]);
        if (twin_[a] != none) add(a, on_skin(b), twin_[a]);
      }
    }
    for (SurfaceFace& face : result_.face)
      if (is_skin(face))
        for (std::uint32_t& p : face.point) p = on_skin(p);
    result_.walls = wall.size();
    result_.face.insert(result_.face.end(), wall.begin(), wall.end());
  }

  Vec3d area_of(const std::array<std::uint32_t, 3>& point) const {
    const Vec3d& a = result_.position[point[0]];
    return (result_.position[point[1]] - a).cross(result_.position[point[2]] - a);
  }
  std::array<Vec3f, 3> flat_normals(const std::array<std::uint32_t, 3>& point) const {
    const Vec3d area = area_of(point);
    const Vec3f n = (area.norm() > 0 ? Vec3d(area.normalized()) : Vec3d::UnitZ()).cast<float>();
    return {n, n, n};
  }

  void set_normals() {
    const std::size_t count = result_.face.size() - result_.walls;
    std::vector<std::uint32_t> begin(result_.position.size() + 1, 0), around;
    for (std::size_t f = 0; f < count; ++f)
      if (is_skin(result_.face[f]))
        for (const std::uint32_t p : result_.face[f].point) ++begin[p + 1];
    for (std::size_t p = 1; p < begin.size(); ++p) begin[p] += begin[p - 1];
    around.resize(begin.back());
    std::vector<std::uint32_t> at(begin.begin(), begin.end() - 1);
    for (std::uint32_t f = 0; f < count; ++f)
      if (is_skin(result_.face[f]))
        for (std::uint32_t i = 0; i < 3; ++i) around[at[result_.face[f].point[i]]++] = 3 * f + i;
    std::vector<std::array<Vec3f, 3>> normal(count);
    std::vector<std::uint8_t> turned(count, 0);
    parallel_for(count, 1024, [&](std::size_t f) {
      const SurfaceFace& face = result_.face[f];
      normal[f] = face.normal;
      if (!is_skin(face)) return;
      for (int i = 0; i < 3; ++i) {
        Vec3d sum = Vec3d::Zero();
        for (std::uint32_t k = begin[face.point[i]]; k < begin[face.point[i] + 1]; ++k) {
          const SurfaceFace& other = result_.face[around[k] / 3];
          if (other.normal[around[k] % 3].dot(face.normal[i]) > same_normal) sum += area_of(other.point);
        }
        if (sum.norm() > 0) normal[f][i] = sum.normalized().cast<float>();
      }
      turned[f] = area_of(face.point).dot((face.normal[0] + face.normal[1] + face.normal[2]).cast<double>()) < 0;
    });
    for (std::size_t f = 0; f < count; ++f) {
      result_.face[f].normal = normal[f];
      result_.turned += turned[f];
    }
  }

  const TetMesh& mesh_;
  const Boundary& boundary_;
  DisplacedSurface result_;
  std::vector<FacetId> facet_;
  std::vector<std::uint8_t> rim_;
  std::vector<std::uint32_t> twin_; ///< of rim points that moved
};

} // namespace

DisplacedSurface displace(std::vector<Vec3d> rest, std::vector<SurfaceFace> face, const TetMesh& mesh,
                          const Boundary& boundary, const ReliefFunction& height, const DisplaceOptions& options) {
  if (!(options.scale >= 0) || !std::isfinite(options.scale))
    throw InvalidInput("displacement", "is " + std::to_string(options.scale), "give a factor of 0 or more");
  if (!(options.max_edge >= 0) || !std::isfinite(options.max_edge))
    throw InvalidInput("displacement_edge", "is " + std::to_string(options.max_edge) + " mm",
                       "give a length, or 0 for the default");
  if (options.scale == 0) {
    DisplacedSurface as_it_was;
    as_it_was.position = rest;
    as_it_was.rest = std::move(rest);
    as_it_was.face = std::move(face);
    return as_it_was;
  }
  return Displacer(std::move(rest), std::move(face), mesh, boundary).run(height, options);
}

} // namespace pith
