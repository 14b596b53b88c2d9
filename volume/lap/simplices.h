#pragma once
// What patch growing, warping and coverage need of a mesh, the same for the tets of a solid and the triangles of a
// skin.
#include "volume/mesh/tet_mesh.h"

namespace pith {

/// Simplices with `corners` corners each (4: tets, 3: triangles), their adjacency and the gradients of their
/// barycentric coordinates. Row i of the flat arrays starts at i · corners.
struct Simplices {
  int corners = 4;
  std::vector<std::uint32_t> corner;
  std::vector<std::uint32_t> neighbor; ///< across the side opposite each corner; `none` outside
  std::vector<Vec3d> gradient;         ///< 1/mm; of a triangle's, tangent to it
  std::vector<double> measure;         ///< mm³ or mm²
  std::vector<Vec3d> center;           ///< barycentre
  std::span<const Vec3d> position;     ///< of the vertices; refers to the mesh
  std::size_t vertex_count = 0;
  std::size_t count = 0;

  static constexpr std::uint32_t none = 0xffffffffu;
};

/// All tets of a mesh, in its numbering. Tets of other regions than `region` have no neighbours here and measure 0.
Simplices simplices_of(const TetMesh& mesh, std::int32_t region);

} // namespace pith
