// What stands between a surface and a tet mesh.
#include "volume/mesh/surface_defects_intersections.h"
#include "volume/mesh/tetrahedralize_shells.h"
#include "volume/mesh/tri_mesh.h"

#include <algorithm>
#include <cstdio>

namespace pith {

bool SurfaceDefects::clean() const {
  return non_finite_vertices + degenerate_triangles + duplicate_triangles + border_edges + non_manifold_edges +
                 non_manifold_vertices + misoriented_edges + self_intersecting_triangles + inside_out_shells ==
             0 &&
         shells > 0 && volume > 0;
}

std::string SurfaceDefects::summary() const {
  std::string text;
  bool placed = false;
  const auto add = [&](std::size_t count, const char* one, const char* many) {
    if (count == 0) return;
    if (!text.empty()) text += ", ";
    text += std::to_string(count) + " " + (count == 1 ? one : many);
    placed = true;
  };
  add(non_finite_vertices, "vertex that is not finite", "vertices that are not finite");
  add(degenerate_triangles, "degenerate triangle", "degenerate triangles");
  add(duplicate_triangles, "duplicate triangle", "duplicate triangles");
  add(border_edges, "border edge", "border edges");
  add(non_manifold_edges, "non-manifold edge", "non-manifold edges");
  add(non_manifold_vertices, "non-manifold vertex", "non-manifold vertices");
  add(misoriented_edges, "misoriented edge", "misoriented edges");
  add(self_intersecting_triangles, "self-intersecting triangle", "self-intersecting triangles");
  add(inside_out_shells, "shell turned inside out", "shells turned inside out");
  if (shells == 0)
    text += text.empty() ? "no triangles" : ", no triangles";
  else if (!(volume > 0) && inside_out_shells == 0)
    text += text.empty() ? "no volume" : ", no volume";
  if (text.empty()) return "no defects";
  if (placed) {
    char place[96];
    std::snprintf(place, sizeof place, ", near (%.6g, %.6g, %.6g)", first_defect.x(), first_defect.y(),
                  first_defect.z());
    text += place;
  }
  return text;
}

namespace {

SurfaceDefects defects_of(const TriMesh& mesh, bool with_intersections) {
  SurfaceDefects defects;
  bool placed = false;
  const auto note = [&](const Vec3d& place) {
    if (!placed) defects.first_defect = place;
    placed = true;
  };
  const auto middle = [&](TriangleId t) {
    const auto& corner = mesh.corner[t];
    return Vec3d((mesh.position[corner[0]] + mesh.position[corner[1]] + mesh.position[corner[2]]) / 3);
  };

  for (const Vec3d& p : mesh.position)
    if (!p.allFinite()) {
      ++defects.non_finite_vertices;
      note(p);
    }

  // Edges: what two triangles share.
  const std::vector<surface::EdgeSide> sides = surface::edge_sides(mesh);
  surface::for_each_edge(sides, [&](const surface::EdgeSide* first, const surface::EdgeSide* last) {
    const auto count = last - first;
    std::size_t* defect = nullptr;
    if (count == 1)
      defect = &defects.border_edges;
    else if (count > 2)
      defect = &defects.non_manifold_edges;
    else if (first[0].forward == first[1].forward)
      defect = &defects.misoriented_edges;
    if (defect) {
      ++*defect;
      note((mesh.position[VertexId(first->low)] + mesh.position[VertexId(first->high)]) / 2);
    }
  });

  const PerVertex<char> torn = surface::torn_vertices(mesh, sides);
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count()))
    if (torn[v]) {
      ++defects.non_manifold_vertices;
      note(mesh.position[v]);
    }

  // Triangles with the same three corners.
  std::vector<std::array<std::uint32_t, 4>> sorted;
  sorted.reserve(mesh.triangle_count());
  for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count())) {
    std::array<std::uint32_t, 3> corner = {mesh.corner[t][0], mesh.corner[t][1], mesh.corner[t][2]};
    std::sort(corner.begin(), corner.end());
    sorted.push_back({corner[0], corner[1], corner[2], t});
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (std::equal(sorted[i].begin(), sorted[i].begin() + 3, sorted[i - 1].begin())) {
      ++defects.duplicate_triangles;
      note(middle(TriangleId(sorted[i][3])));
    }

  if (defects.non_finite_vertices == 0) {
    const PerTriangle<char> collinear = surface::collinear_triangles(mesh);
    const PerTriangle<char> intersecting = with_intersections ? surface::intersecting_triangles(mesh, collinear)
                                                              : PerTriangle<char>(mesh.triangle_count(), 0);
    for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count())) {
      defects.degenerate_triangles += collinear[t] ? 1 : 0;
      defects.self_intersecting_triangles += intersecting[t] ? 1 : 0;
      if (collinear[t] || intersecting[t]) note(middle(t));
    }
    defects.volume = signed_volume(mesh);
    const std::vector<surface::Shell> shells = surface::shells_of(mesh, sides);
    defects.shells = shells.size();
    for (const surface::Shell& shell : shells)
      if (shell.closed && shell.depth == 0 && shell.volume < 0) {
        ++defects.inside_out_shells;
        note(middle(shell.triangle[0]));
      }
  }
  return defects;
}

} // namespace

SurfaceDefects surface_defects(const TriMesh& mesh) { return defects_of(mesh, true); }

SurfaceDefects surface::defects_but_intersections(const TriMesh& mesh) { return defects_of(mesh, false); }

} // namespace pith
