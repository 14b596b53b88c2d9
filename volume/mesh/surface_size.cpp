// Which sizes of surfaces are refused.
#include "volume/mesh/surface_size.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cstdio>

namespace pith {
namespace {

constexpr double least_size = 1e-9, most_size = 1e12; // mm

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

} // namespace

void require_usable_size(const TriMesh& mesh, const std::string& name) {
  Box box;
  for (const auto& corner : mesh.corner)
    for (const VertexId v : corner) {
      const double farthest = mesh.position[v].cwiseAbs().maxCoeff();
      if (!(farthest <= most_size))
        throw InvalidInput(name, "vertex " + std::to_string(v) + " lies " + text_of(farthest) + " mm from the origin",
                           "give a smaller surface/scale, or move it: coordinates go up to " + text_of(most_size) +
                               " mm");
      box.add(mesh.position[v]);
    }
  if (mesh.corner.empty()) return;
  const double size = box.extent().maxCoeff();
  if (size > 0 && size < least_size)
    throw InvalidInput(name, "the surface is " + text_of(size) + " mm across",
                       "give a larger surface/scale: sizes start at " + text_of(least_size) + " mm");
}

} // namespace pith
