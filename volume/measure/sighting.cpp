#include "volume/measure/sighting.h"

#include <algorithm>

namespace pith {

const SeenLookup* Sighting::dominant() const {
  const SeenLookup* best = nullptr;
  for (const SeenLookup& s : seen)
    if (!best || s.share > best->share) best = &s;
  return best;
}

void look_at(const LayerReader& reader, TetId tet, const std::array<double, 4>& barycentric, Sighting& sighting) {
  sighting.seen.clear();
  sighting.coverage = 0;
  sighting.masked = 0;
  const Layer& layer = *reader.layer;
  std::array<float, 4> b;
  for (int k = 0; k < 4; ++k) b[k] = static_cast<float>(barycentric[k]);
  const std::span<const Lookup> lookups = lookups_of(layer, tet);
  const bool over = layer.blend.mix == Blend::Mix::over;
  float sum = 0;
  for (std::size_t i = lookups.size(); i-- > 0;) { // uppermost first
    const LookupSight sight = sight_of(reader, lookups[i], b);
    if (!(sight.alpha > 0)) continue;
    ++sighting.masked;
    const float alpha = over ? std::min(sight.alpha, 1.0f) : sight.alpha;
    const float share = over ? (1 - sighting.coverage) * alpha : alpha;
    if (over) sighting.coverage += share;
    sum += share;
    if (!(share > 0)) continue;
    const LayerReader::PatchReader& patch = reader.patch[lookups[i].patch];
    const Lanes u = patch.scale * sight.w + patch.offset;
    sighting.seen.push_back({&lookups[i], share, {u[0], u[1], u[2], u[3]}});
  }
  if (over || !(sum > 0)) return;
  sighting.coverage = layer.blend.mix == Blend::Mix::weighted ? std::min(1.0f, sum) : 1.0f;
  for (SeenLookup& s : sighting.seen) s.share *= sighting.coverage / sum;
}

} // namespace pith
