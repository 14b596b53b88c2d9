#include "volume/lap/mixing.h"

#include "volume/base/random.h"
#include "volume/layer/composite.h"

#include <algorithm>
#include <cmath>

namespace pith {

float correlation_where_mixed(const Simplices& mesh, const Layer& layer) {
  constexpr std::size_t points = 20000;
  constexpr float well_seen = 0.2f;
  const LayerReader reader(layer, false);
  double together = 0, alone = 0;
  std::array<std::array<float, max_components>, 2> deviation;
  for (std::size_t k = 0; k < points; ++k) {
    const std::uint32_t s = static_cast<std::uint32_t>(k * mesh.count / points);
    Random random(hash_of(0x313, k));
    std::array<float, 4> b;
    float sum = 0;
    for (float& x : b) sum += x = static_cast<float>(-std::log(1 - random.uniform()));
    for (float& x : b) x /= sum;

    int seen = 0;
    float through = 1;
    for (std::uint32_t i = layer.begin[s + 1]; i-- > layer.begin[s] && seen < 2 && through > well_seen;) {
      const LookupSight sight = sight_of(reader, layer.lookup[i], b);
      const float alpha = std::clamp(sight.alpha, 0.0f, 1.0f);
      if (through * alpha >= well_seen) {
        const LayerReader::PatchReader& patch = reader.patch[layer.lookup[i].patch];
        const Lanes u = patch.scale * sight.w + patch.offset;
        const TexelGrid &texels = patch.source->level.front(), &means = patch.source->mean;
        std::array<float, max_components> mean;
        std::array<float, max_components>& away = deviation[seen++];
        sample(texels, cell_at(texels, u), away.data());
        sample(means, cell_at(means, u), mean.data());
        for (int c = 0; c < reader.components; ++c) away[c] -= mean[c];
      }
      through *= 1 - alpha;
    }
    if (seen < 2) continue;
    for (int c = 0; c < reader.components; ++c) {
      if (!reader.preserved[c]) continue;
      const double x = deviation[0][c], y = deviation[1][c];
      together += x * y;
      alone += 0.5 * (x * x + y * y);
    }
  }
  return alone > 0 ? static_cast<float>(std::clamp(together / alone, 0.0, 1.0)) : 0.0f;
}

} // namespace pith
