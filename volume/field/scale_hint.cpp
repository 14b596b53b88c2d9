#include "volume/field/scale_hint.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace pith {

std::string scale_hint(const TetMesh& mesh, std::span<const Vec3d> stroke, const std::string& otherwise) {
  constexpr double orders_of_magnitude = 30;
  const auto farthest = [](const auto& points) { // from the origin: strokes may be points
    double most = 0;
    for (const Vec3d& p : points) most = std::max(most, p.norm());
    return most;
  };
  const double of_mesh = farthest(mesh.position), of_stroke = farthest(stroke);
  if (!(of_mesh > 0 && of_stroke > 0)) return otherwise;
  const double ratio = of_stroke / of_mesh;
  if (ratio < orders_of_magnitude && ratio > 1 / orders_of_magnitude) return otherwise;
  std::ostringstream text;
  text.precision(3);
  text << "the stroke reaches " << of_stroke << " mm from the origin, the mesh " << of_mesh << " mm: ";
  if (ratio > 1)
    text << "a surface file in metres needs \"surface\": {\"scale\": 1000}";
  else
    text << "draw the stroke in millimetres, as the surface is after \"scale\"";
  return text.str();
}

} // namespace pith
