#include "volume/lap/turning.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pith {

std::vector<float> turning_of(const Simplices& mesh, const FrameSource& frames,
                              std::span<const std::uint8_t> singular) {
  std::vector<float> turning(mesh.count, 0.0f);
  if (frames.fixed_axes == 0) return turning;
  parallel_for(mesh.count, 1024, [&](std::size_t s) {
    if (!(mesh.measure[s] > 0)) return;
    if (!singular.empty() && singular[s]) {
      turning[s] = std::numbers::pi_v<float>;
      return;
    }
    const PasteFrames from_here(frames, frames.axes[s]);
    double least = 1;
    for (int k = 0; k < mesh.corners; ++k) {
      const std::uint32_t next = mesh.neighbor[s * mesh.corners + k];
      if (next != Simplices::none) least = std::min(least, from_here.cosine(next));
    }
    turning[s] = static_cast<float>(std::acos(std::max(least, -1.0)));
  });
  return turning;
}

} // namespace pith
