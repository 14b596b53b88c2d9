#include "volume/io/surface_export.h"
#include "volume/layer/relief.h"

#include "volume/base/error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

namespace pith {

namespace {

/// Facets that turn away from their vertex's smooth normal by more than about 40° keep their own: the edges of a box.
constexpr double crease_cosine = 0.766;
constexpr std::size_t block = 512; // vertices of one parallel step

Vec3d flat_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d area = (b - a).cross(c - a);
  const double length = area.norm();
  return length > 0 ? Vec3d(area / length) : Vec3d(0, 0, 1);
}

/// Normals of the root's skin at any point of it, so that cuts leave the shading of the skin as it was.
class SkinNormals {
public:
  SkinNormals(const TetMesh& mesh, const Boundary& boundary)
      : mesh_(mesh), boundary_(boundary), vertex_(skin_normals(mesh, boundary)) {}

  Vec3f at(FacetId facet, const Vec3d& x) const {
    const auto& corner = boundary_.corner[facet];
    const std::array<Vec3d, 3> p = {mesh_.position[corner[0]], mesh_.position[corner[1]], mesh_.position[corner[2]]};
    const Vec3d flat = flat_normal(p[0], p[1], p[2]);
    if (boundary_.behind[facet].exists()) return flat.cast<float>(); // an interface: not part of the skin
    std::array<Vec3d, 3> smooth;
    for (int i = 0; i < 3; ++i) {
      smooth[i] = vertex_[corner[i]].dot(flat) >= crease_cosine ? vertex_[corner[i]] : flat;
      if (x == p[i]) return smooth[i].cast<float>();
    }
    const NearestFacet nearest = closest_point(p, x);
    const Vec3d sum =
        nearest.barycentric[0] * smooth[0] + nearest.barycentric[1] * smooth[1] + nearest.barycentric[2] * smooth[2];
    return sum.normalized().cast<float>();
  }

private:
  const TetMesh& mesh_;
  const Boundary& boundary_;
  PerVertex<Vec3d> vertex_;
};

/// The faces of one piece with their normals.
std::vector<SurfaceFace> faces_of(const PieceSurface& surface, const Pieces& pieces, const TetMesh& mesh,
                                  const SkinNormals& skin) {
  // On which side of each cut the piece lies: its section faces outwards against or along the cut's field.
  std::map<std::uint32_t, double> side;
  std::vector<SurfaceFace> face;
  face.reserve(surface.triangle.size());
  for (const PieceSurface::Triangle& triangle : surface.triangle) {
    SurfaceFace& f = face.emplace_back(SurfaceFace{triangle.corner, {}, triangle.root, triangle.tag});
    const std::array<Vec3d, 3> x = {surface.position[f.point[0]], surface.position[f.point[1]],
                                    surface.position[f.point[2]]};
    if (f.tag.is_skin()) {
      for (int i = 0; i < 3; ++i) f.normal[i] = skin.at(f.tag.facet(), x[i]);
      continue;
    }
    const Vec3d area = (x[1] - x[0]).cross(x[2] - x[0]);
    for (int i = 0; i < 3; ++i) {
      f.normal[i] = section_normal(pieces, mesh, surface.vertex[f.point[i]], f.tag.cut());
      side[f.tag.cut()] += area.dot(f.normal[i].cast<double>());
    }
  }
  for (SurfaceFace& f : face) {
    if (!f.tag.is_section()) continue;
    const bool inward = side[f.tag.cut()] < 0;
    for (int i = 0; i < 3; ++i) {
      if (f.normal[i].isZero())
        f.normal[i] =
            flat_normal(surface.position[f.point[0]], surface.position[f.point[1]], surface.position[f.point[2]])
                .cast<float>();
      else if (inward)
        f.normal[i] = -f.normal[i];
    }
  }
  return face;
}

/// Skin has code ≥ 0; sections have −2, −3 ... in the order of the cuts.
void sort_by_part(std::vector<SurfaceFace>& face) {
  std::stable_sort(face.begin(), face.end(), [](const SurfaceFace& a, const SurfaceFace& b) {
    return std::min(a.tag.code, 0) > std::min(b.tag.code, 0);
  });
}

/// Corners that are one vertex: the same point, region and normal within a part.
struct CornerKey {
  std::uint32_t point;
  std::int32_t region;
  std::array<std::uint32_t, 3> normal; // bits
  std::uint32_t corner;                // 3 · face + corner: the first of equal ones stands for all

  auto same_vertex() const { return std::tie(point, region, normal); }
  bool operator<(const CornerKey& other) const {
    return std::tie(point, region, normal, corner) < std::tie(other.point, other.region, other.normal, other.corner);
  }
};

class SurfaceBuilder {
public:
  SurfaceBuilder(const Root& root, const Pieces& pieces, const SurfaceOptions& options)
      : root_(root), pieces_(pieces), options_(options), relief_(root),
        skin_(root.model().mesh, root.model().boundary) {}

  void add_piece(std::uint32_t p) {
    const TetMesh& mesh = root_.model().mesh;
    PieceSurface surface = surface_of(pieces_, p, mesh, root_.model().boundary);
    std::vector<SurfaceFace> face = faces_of(surface, pieces_, mesh, skin_);
    std::vector<Vec3d> rest = std::move(surface.position);
    if (options_.max_edge > 0) {
      const std::size_t left = options_.max_triangles - std::min(options_.max_triangles, result_.triangle.size());
      subdivide(rest, face, options_.max_edge, left);
    }
    std::vector<Vec3d> position = rest;
    if (relief_.exists() && options_.displacement.scale > 0) {
      const auto height = [&](const Vec3d& x, FacetId facet, TetId tet) {
        return relief_.at({.position = x, .region = mesh.region[tet], .facet = facet, .hint = tet});
      };
      DisplacedSurface displaced =
          displace(std::move(rest), std::move(face), mesh, root_.model().boundary, height, options_.displacement);
      position = std::move(displaced.position);
      rest = std::move(displaced.rest);
      face = std::move(displaced.face);
      result_.turned += displaced.turned;
    }
    sort_by_part(face);
    const auto first_point = static_cast<std::uint32_t>(result_.position.size());
    for (const Vec3d& x : position) result_.position.push_back(pieces_.piece[p].placement(x));
    for (std::size_t begin = 0, end = 0; begin < face.size(); begin = end) {
      const auto kind = [&](std::size_t f) { return std::min(face[f].tag.code, 0); };
      while (end < face.size() && kind(end) == kind(begin)) ++end;
      add_part(p, first_point, rest, {face.data() + begin, face.data() + end});
    }
  }

  /// Asks for the material at every vertex.
  ColoredSurface finished(const Progress& progress) {
    const int component = std::max(0, root_.component_of("color"));
    constexpr std::size_t step = 64 * block; // between two reports
    for (std::size_t begin = 0; begin < point_.size(); begin += step) {
      report(progress, double(begin) / double(point_.size()));
      parallel_for(std::min(step, point_.size() - begin), block, [&](std::size_t i) {
        const Material material = material_at(root_, point_[begin + i]);
        for (int c = 0; c < 3; ++c) result_.vertex[begin + i].color[c] = material.value[component + c];
      });
    }
    report(progress, 1);
    return std::move(result_);
  }

private:
  void add_part(std::uint32_t p, std::uint32_t first_point, const std::vector<Vec3d>& rest,
                std::span<const SurfaceFace> face) {
    std::vector<CornerKey> key;
    key.reserve(3 * face.size());
    for (std::size_t f = 0; f < face.size(); ++f)
      for (int i = 0; i < 3; ++i) {
        const Vec3f& n = face[f].normal[i];
        key.push_back({face[f].point[i],
                       root_.model().mesh.region[face[f].root],
                       {std::bit_cast<std::uint32_t>(n.x()), std::bit_cast<std::uint32_t>(n.y()),
                        std::bit_cast<std::uint32_t>(n.z())},
                       static_cast<std::uint32_t>(3 * f + i)});
      }
    std::sort(key.begin(), key.end());

    const auto triangle_begin = static_cast<std::uint32_t>(result_.triangle.size());
    const auto vertex_begin = static_cast<std::uint32_t>(result_.vertex.size());
    result_.triangle.resize(result_.triangle.size() + face.size());
    const Mat3d& rotation = pieces_.piece[p].placement.rotation;
    for (std::size_t k = 0; k < key.size(); ++k) {
      if (k == 0 || key[k].same_vertex() != key[k - 1].same_vertex()) {
        const SurfaceFace& f = face[key[k].corner / 3];
        const Vec3d normal = f.normal[key[k].corner % 3].cast<double>();
        result_.vertex.push_back({first_point + key[k].point, (rotation * normal).cast<float>(), Vec3f(0, 0, 0)});
        point_.push_back(
            {.position = rest[key[k].point], .region = key[k].region, .facet = f.tag.facet(), .hint = f.root});
      }
      result_.triangle[triangle_begin + key[k].corner / 3][key[k].corner % 3] =
          static_cast<std::uint32_t>(result_.vertex.size() - 1);
    }
    result_.part.push_back({p, face.front().tag.cut(), triangle_begin,
                            static_cast<std::uint32_t>(result_.triangle.size()), vertex_begin,
                            static_cast<std::uint32_t>(result_.vertex.size())});
  }

  const Root& root_;
  const Pieces& pieces_;
  const SurfaceOptions& options_;
  Relief relief_;
  SkinNormals skin_;
  ColoredSurface result_;
  std::vector<MaterialPoint> point_; // parallel to result_.vertex
};

} // namespace

ColoredSurface colored_surface(const Root& root, const Pieces& pieces, const SurfaceOptions& options,
                               const Progress& progress) {
  if (!(options.max_edge >= 0) || !std::isfinite(options.max_edge))
    throw InvalidInput("max_edge", "is " + std::to_string(options.max_edge) + " mm", "give a length, or 0 for none");
  SurfaceBuilder builder(root, pieces, options);
  for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) builder.add_piece(p);
  return builder.finished(progress);
}

} // namespace pith
