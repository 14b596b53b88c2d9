#include "raytrace/scene_surface.h"

#include "volume/base/parallel.h"
#include "volume/layer/relief.h"
#include "volume/mesh/facet_tree.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace pith {

namespace {

/// A triangle by its vertices and the place of its piece.
struct FaceKey {
  std::uint32_t place;
  std::array<std::uint32_t, 3> vertex; ///< ascending
  std::uint32_t piece, triangle;
  auto face() const { return std::tuple(place, vertex[0], vertex[1], vertex[2]); }
  bool operator<(const FaceKey& other) const {
    return std::tuple(face(), piece, triangle) < std::tuple(other.face(), other.piece, other.triangle);
  }
};

/// Pieces with equal placements share a number: the lowest such piece.
std::vector<std::uint32_t> places_of(const Pieces& pieces) {
  std::vector<std::uint32_t> place(pieces.piece.size());
  for (std::size_t p = 0; p < place.size(); ++p) {
    place[p] = static_cast<std::uint32_t>(p);
    const Rigid& own = pieces.piece[p].placement;
    for (std::size_t q = 0; q < p; ++q)
      if (pieces.piece[q].placement.rotation == own.rotation &&
          pieces.piece[q].placement.translation == own.translation) {
        place[p] = place[q];
        break;
      }
  }
  return place;
}

/// The normals of one piece's sections: the gradient of the cut's field at vertices that the cut added, the mean of
/// the section's triangles at others (a cut that ran exactly through a vertex, or a rim that a later cut subdivided).
void add_section_normals(const Pieces& pieces, const PieceSurface& whole, VisibleSurface& surface) {
  struct Corner {
    std::int32_t tag;
    std::uint32_t vertex, triangle;
    std::uint8_t corner;
  };
  std::vector<Corner> corners;
  const auto& triangles = surface.triangle;
  std::vector<Vec3d> area(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (!triangles[t].tag.is_section()) continue;
    const auto& c = triangles[t].corner;
    area[t] =
        (surface.position[c[1]] - surface.position[c[0]]).cross(surface.position[c[2]] - surface.position[c[0]]);
    for (std::uint8_t i = 0; i < 3; ++i) corners.push_back({triangles[t].tag.code, c[i], t, i});
  }
  surface.normal_row.assign(triangles.size(), {});
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return std::tuple(a.tag, a.vertex, a.triangle) < std::tuple(b.tag, b.vertex, b.triangle);
  });
  for (std::size_t begin = 0; begin < corners.size();) {
    std::size_t end = begin;
    Vec3d mean = Vec3d::Zero();
    for (; end < corners.size() && corners[end].tag == corners[begin].tag &&
           corners[end].vertex == corners[begin].vertex;
         ++end) {
      mean += area[corners[end].triangle];
      surface.normal_row[corners[end].triangle][corners[end].corner] =
          static_cast<std::uint32_t>(surface.normal.size());
    }
    Vec3d normal = mean.normalized();
    const VertexId vertex = whole.vertex[corners[begin].vertex];
    if (vertex >= pieces.root_vertex_count) {
      const std::size_t row = vertex - pieces.root_vertex_count;
      const FaceTag tag{corners[begin].tag};
      if (pieces.added[row].cut == tag.cut() && row < pieces.added_normal.size()) {
        const Vec3d gradient = pieces.added_normal[row].cast<double>();
        const double along = gradient.dot(mean);
        if (gradient.allFinite() && std::abs(along) > 0.2 * mean.norm() * gradient.norm())
          normal = (along < 0 ? -gradient : gradient).normalized();
      }
    }
    surface.normal.push_back((normal.allFinite() ? normal : Vec3d::Zero()).cast<float>());
    begin = end;
  }
}

/// The surface with its skin displaced.
void add_relief(const Relief& relief, const Model& model, const PerFacet<std::array<Vec3f, 3>>& skin_normal,
                const DisplaceOptions& options, VisibleSurface& surface) {
  std::vector<SurfaceFace> face;
  face.reserve(surface.triangle.size());
  for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
    const PieceSurface::Triangle& triangle = surface.triangle[t];
    SurfaceFace& f = face.emplace_back(SurfaceFace{triangle.corner, {}, triangle.root, triangle.tag});
    for (int i = 0; i < 3; ++i) {
      if (!triangle.tag.is_skin()) {
        f.normal[i] = surface.normal[surface.normal_row[t][i]];
        continue;
      }
      const auto& corner = model.boundary.corner[triangle.tag.facet()];
      const std::array<Vec3f, 3>& normal = skin_normal[triangle.tag.facet()];
      const NearestFacet at = closest_point(
          {model.mesh.position[corner[0]], model.mesh.position[corner[1]], model.mesh.position[corner[2]]},
          surface.position[triangle.corner[i]]);
      Vec3d sum = Vec3d::Zero();
      for (int k = 0; k < 3; ++k) sum += at.barycentric[k] * normal[k].cast<double>();
      f.normal[i] = sum.normalized().cast<float>();
    }
  }
  const auto height = [&](const Vec3d& x, FacetId facet, TetId tet) {
    return relief.at({.position = x, .region = model.mesh.region[tet], .facet = facet, .hint = tet});
  };
  DisplacedSurface displaced =
      displace(std::move(surface.position), std::move(face), model.mesh, model.boundary, height, options);
  surface.position = std::move(displaced.position);
  surface.rest = std::move(displaced.rest);
  surface.triangle.clear();
  surface.normal.clear();
  surface.normal_row.clear();
  for (const SurfaceFace& f : displaced.face) {
    const auto row = static_cast<std::uint32_t>(surface.normal.size());
    surface.triangle.push_back({f.point, f.root, f.tag});
    surface.normal_row.push_back({row, row + 1, row + 2});
    surface.normal.insert(surface.normal.end(), f.normal.begin(), f.normal.end());
  }
}

} // namespace

std::vector<VisibleSurface> visible_surfaces(const Root& root, const Pieces& pieces,
                                             const PerFacet<std::array<Vec3f, 3>>& skin_normal,
                                             const DisplaceOptions& displacement) {
  const TetMesh& mesh = root.model().mesh;
  const std::size_t count = pieces.piece.size();
  std::vector<PieceSurface> whole(count);
  parallel_for(count, 1, [&](std::size_t p) {
    whole[p] = surface_of(pieces, static_cast<std::uint32_t>(p), mesh, root.model().boundary);
  });

  // Two triangles on the same three vertices at the same place bound the same matter from both sides: an unmoved
  // section, or an interface between regions. Neither is seen.
  const std::vector<std::uint32_t> place = places_of(pieces);
  std::vector<std::uint32_t> there(count, 0); // pieces that stand where piece i does
  for (const std::uint32_t p : place) ++there[p];
  std::vector<FaceKey> faces;
  for (std::uint32_t p = 0; p < count; ++p)
    for (std::uint32_t t = 0; there[place[p]] > 1 && t < whole[p].triangle.size(); ++t) {
      FaceKey key{place[p], {}, p, t};
      for (int i = 0; i < 3; ++i) key.vertex[i] = whole[p].vertex[whole[p].triangle[t].corner[i]];
      std::sort(key.vertex.begin(), key.vertex.end());
      faces.push_back(key);
    }
  std::sort(faces.begin(), faces.end());
  std::vector<std::vector<std::uint8_t>> hidden(count);
  for (std::size_t p = 0; p < count; ++p) hidden[p].assign(whole[p].triangle.size(), 0);
  for (std::size_t i = 0; i + 1 < faces.size(); ++i)
    if (faces[i].face() == faces[i + 1].face()) {
      hidden[faces[i].piece][faces[i].triangle] = 1;
      hidden[faces[i + 1].piece][faces[i + 1].triangle] = 1;
    }

  const Relief relief(root);
  std::vector<VisibleSurface> result(count);
  parallel_for(count, 1, [&](std::size_t p) {
    VisibleSurface& surface = result[p];
    surface.piece = static_cast<std::uint32_t>(p);
    surface.placement = pieces.piece[p].placement;
    surface.position = whole[p].position;
    for (std::size_t t = 0; t < whole[p].triangle.size(); ++t)
      if (!hidden[p][t]) surface.triangle.push_back(whole[p].triangle[t]);
    add_section_normals(pieces, whole[p], surface);
    if (relief.exists() && displacement.scale > 0 && !surface.triangle.empty())
      add_relief(relief, root.model(), skin_normal, displacement, surface);
  });
  return result;
}

PerFacet<std::array<Vec3f, 3>> facet_corner_normals(const TetMesh& mesh, const Boundary& boundary, double crease) {
  const std::size_t count = boundary.facet_count();
  PerFacet<Vec3d> area(count);
  std::vector<std::uint32_t> begin(mesh.vertex_count() + 1, 0);
  for (const FacetId f : all_ids<FacetId>(count)) {
    const auto& c = boundary.corner[f];
    const Vec3d& a = mesh.position[c[0]];
    area[f] = (mesh.position[c[1]] - a).cross(mesh.position[c[2]] - a);
    if (boundary.behind[f].exists()) continue;
    for (const VertexId v : c) ++begin[v + 1];
  }
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) begin[v + 1] += begin[v];
  std::vector<FacetId> around(begin.back());
  std::vector<std::uint32_t> at(begin.begin(), begin.end() - 1);
  for (const FacetId f : all_ids<FacetId>(count)) {
    if (boundary.behind[f].exists()) continue;
    for (const VertexId v : boundary.corner[f]) around[at[v]++] = f;
  }
  PerFacet<std::array<Vec3f, 3>> result(count);
  const double least = std::cos(crease);
  parallel_for(count, 4096, [&](std::size_t i) {
    const FacetId f(i);
    const Vec3d own = area[f].normalized();
    for (int k = 0; k < 3; ++k) {
      Vec3d sum = Vec3d::Zero();
      const VertexId v = boundary.corner[f][k];
      for (std::uint32_t j = begin[v]; j < begin[v + 1]; ++j) {
        const Vec3d& other = area[around[j]];
        if (other.dot(own) >= least * other.norm()) sum += other;
      }
      const double length = sum.norm();
      result[f][k] = (length > 0 && !boundary.behind[f].exists() ? Vec3d(sum / length) : own).cast<float>();
    }
  });
  return result;
}

} // namespace pith
