#include "viewer/drawn_surface.h"

#include "raytrace/scene_surface.h"
#include "volume/base/parallel.h"
#include "volume/mesh/facet_tree.h"

#include <mutex>

namespace pith {
namespace {

std::array<float, 3> floats(const Vec3d& v) { return {float(v.x()), float(v.y()), float(v.z())}; }
Vec3d vector_of(const std::array<float, 3>& f) { return {f[0], f[1], f[2]}; }

/// Barycentric coordinates; most points are corners, of which nothing need be computed.
std::array<double, 4> in_tet(const TetMesh& mesh, TetId tet, const Vec3d& x) {
  for (int i = 0; i < 4; ++i)
    if (mesh.position[mesh.corner[tet][i]] == x) {
      std::array<double, 4> corner{};
      corner[i] = 1;
      return corner;
    }
  return barycentric(mesh, tet, x);
}
std::array<double, 3> in_facet_of(const Model& model, FacetId facet, const Vec3d& x) {
  const auto& c = model.boundary.corner[facet];
  std::array<Vec3d, 3> triangle;
  for (int i = 0; i < 3; ++i) {
    triangle[i] = model.mesh.position[c[i]];
    if (triangle[i] == x) {
      std::array<double, 3> corner{};
      corner[i] = 1;
      return corner;
    }
  }
  return closest_point(triangle, x).barycentric;
}

} // namespace

DrawnSurface drawn_surface(const Root& root, const Pieces& pieces, const PerFacet<std::array<Vec3f, 3>>& skin_normal,
                           const DisplaceOptions& displacement) {
  const Model& model = root.model();
  const std::vector<VisibleSurface> visible = visible_surfaces(root, pieces, skin_normal, displacement);
  DrawnSurface drawn;
  std::size_t total = 0;
  for (const VisibleSurface& surface : visible) {
    drawn.piece.push_back({surface.piece, surface.placement, 3 * total, 3 * (total + surface.triangle.size())});
    total += surface.triangle.size();
  }
  drawn.vertex.resize(3 * total);
  drawn.tag.resize(total);
  for (std::size_t p = 0; p < visible.size(); ++p) {
    const VisibleSurface& surface = visible[p];
    const std::vector<Vec3d>& rest = surface.rest.empty() ? surface.position : surface.rest;
    const std::size_t first = drawn.piece[p].begin;
    parallel_for(surface.triangle.size(), 1024, [&](std::size_t t) {
      const PieceSurface::Triangle& triangle = surface.triangle[t];
      const FacetId facet = triangle.tag.facet();
      drawn.tag[first / 3 + t] = triangle.tag;
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t corner = triangle.corner[i];
        const Vec3d& x = rest[corner];
        const std::array<double, 4> b = in_tet(model.mesh, triangle.root, x);
        DrawnVertex& v = drawn.vertex[first + 3 * t + i];
        v.position = floats(surface.position[corner]);
        v.in_tet = {float(b[0]), float(b[1]), float(b[2])};
        v.in_facet = {0, 0};
        v.tet = triangle.root;
        v.facet = facet;
        v.region = model.mesh.region[triangle.root];
        std::array<double, 3> in_facet{};
        if (facet.exists()) {
          in_facet = in_facet_of(model, facet, x);
          v.in_facet = {float(in_facet[0]), float(in_facet[1])};
        }
        Vec3f normal;
        if (facet.exists() && surface.rest.empty()) {
          normal = Vec3f::Zero();
          for (int k = 0; k < 3; ++k) normal += float(in_facet[k]) * skin_normal[facet][k];
          normal.normalize();
        } else {
          normal = surface.normal[surface.normal_row[t][i]];
        }
        v.normal = {normal.x(), normal.y(), normal.z()};
      }
    });
  }
  return drawn;
}

std::optional<SurfaceHit> nearest_hit(const DrawnSurface& surface, const Vec3d& origin, const Vec3d& direction) {
  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    std::size_t triangle = 0;
    double u = 0, v = 0;
  } nearest;
  const DrawnPiece* hit_piece = nullptr;
  std::mutex mutex;
  for (const DrawnPiece& piece : surface.piece) {
    const Vec3d o = piece.placement.inverse(origin), d = piece.placement.rotation.transpose() * direction;
    parallel_blocks((piece.end - piece.begin) / 3, 8192, [&](std::size_t begin, std::size_t end) {
      Nearest best;
      for (std::size_t t = begin; t < end; ++t) { // Möller, Trumbore 1997
        const DrawnVertex* c = &surface.vertex[piece.begin + 3 * t];
        const Vec3d a = vector_of(c[0].position), e = vector_of(c[1].position) - a, f = vector_of(c[2].position) - a;
        const Vec3d p = d.cross(f);
        const double determinant = e.dot(p);
        if (determinant == 0) continue;
        const Vec3d s = o - a;
        const double u = s.dot(p) / determinant;
        if (!(u >= 0 && u <= 1)) continue;
        const Vec3d q = s.cross(e);
        const double v = d.dot(q) / determinant, distance = f.dot(q) / determinant;
        if (v >= 0 && u + v <= 1 && distance > 0 && distance < best.distance)
          best = {distance, piece.begin / 3 + t, u, v};
      }
      const std::lock_guard lock(mutex);
      if (best.distance < nearest.distance ||
          (best.distance == nearest.distance && best.triangle < nearest.triangle && std::isfinite(best.distance))) {
        nearest = best;
        hit_piece = &piece;
      }
    });
  }
  if (!hit_piece) return {};
  const DrawnVertex* c = &surface.vertex[3 * nearest.triangle];
  const double u = nearest.u, v = nearest.v, w = 1 - u - v;
  SurfaceHit hit;
  hit.distance = nearest.distance;
  hit.piece = hit_piece->piece;
  hit.triangle = static_cast<std::uint32_t>(nearest.triangle);
  hit.world = origin + nearest.distance * direction;
  hit.rest = w * vector_of(c[0].position) + u * vector_of(c[1].position) + v * vector_of(c[2].position);
  hit.normal = (hit_piece->placement.rotation *
                (w * vector_of(c[0].normal) + u * vector_of(c[1].normal) + v * vector_of(c[2].normal)))
                   .normalized();
  hit.tet = TetId(c[0].tet);
  hit.tag = surface.tag[nearest.triangle];
  hit.facet = hit.tag.facet();
  return hit;
}

} // namespace pith
