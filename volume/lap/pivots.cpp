#include "volume/lap/pivots.h"

namespace pith {

std::vector<std::uint8_t> pivots_of(const Simplices& mesh, const FrameSource& frames,
                                    std::span<const std::uint8_t> singular) {
  constexpr double shortest_mean = 0.7;
  std::vector<std::uint8_t> pivot(mesh.vertex_count, 0);
  if (frames.fixed_axes == 0) return pivot;
  std::vector<std::uint32_t> first(mesh.vertex_count, Simplices::none), count(mesh.vertex_count, 0);
  std::vector<Mat3d> sum(mesh.vertex_count, Mat3d::Zero());
  for (std::uint32_t s = 0; s < mesh.count; ++s) {
    if (!(mesh.measure[s] > 0)) continue;
    for (int i = 0; i < mesh.corners; ++i) {
      const std::uint32_t v = mesh.corner[std::size_t(s) * mesh.corners + i];
      if (first[v] == Simplices::none) first[v] = s;
      if (!singular.empty() && singular[s]) pivot[v] = 1;
      // As a paste from the first would see it, so that an axis without a sign does not cancel.
      sum[v] += PasteFrames(frames, frames.axes[first[v]]).at(s);
      ++count[v];
    }
  }
  for (std::size_t v = 0; v < mesh.vertex_count; ++v)
    for (int axis = 0; axis < 3; ++axis)
      if (count[v] > 0 && (frames.fixed_axes == 3 || axis == frames.fixed_axis) &&
          sum[v].col(axis).norm() < shortest_mean * count[v])
        pivot[v] = 1;
  return pivot;
}

} // namespace pith
