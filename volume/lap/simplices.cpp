#include "volume/lap/simplices.h"

#include "volume/base/parallel.h"

namespace pith {

Simplices simplices_of(const TetMesh& mesh, std::int32_t region) {
  Simplices s;
  s.corners = 4;
  s.count = mesh.tet_count();
  s.vertex_count = mesh.vertex_count();
  s.position = mesh.position;
  s.corner.resize(4 * s.count);
  s.neighbor.assign(4 * s.count, Simplices::none);
  s.gradient.assign(4 * s.count, Vec3d::Zero());
  s.measure.assign(s.count, 0);
  s.center.resize(s.count);
  parallel_for(s.count, 4096, [&](std::size_t i) {
    const TetId t(i);
    const auto& c = mesh.corner[t];
    for (int k = 0; k < 4; ++k) s.corner[4 * i + k] = c[k];
    s.center[i] = 0.25 * (mesh.position[c[0]] + mesh.position[c[1]] + mesh.position[c[2]] + mesh.position[c[3]]);
    if (mesh.region[t] != region) return;
    s.measure[i] = signed_volume(mesh, t);
    const std::array<Vec3d, 4> gradient = barycentric_gradients(mesh, t);
    for (int k = 0; k < 4; ++k) {
      s.gradient[4 * i + k] = gradient[k];
      const TetId across = mesh.neighbor[t][k];
      if (across.exists() && mesh.region[across] == region) s.neighbor[4 * i + k] = across;
    }
  });
  return s;
}

} // namespace pith
