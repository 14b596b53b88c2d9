#include "volume/layer/relief.h"

#include <algorithm>
#include <limits>

namespace pith {

Relief::Relief(const Root& root) : root_(root) {
  int component = 0;
  for (const Channel& channel : root.channels()) {
    if (channel.semantic == Semantic::height) break;
    component += channel.components;
  }
  if (component >= root.component_count()) return;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const Layer& layer : root.model().layer)
    for (const Exemplar& exemplar : layer.exemplar) {
      int first = 0;
      for (const Channel& channel : exemplar.channel) {
        if (channel.semantic == Semantic::height)
          for (std::size_t t = 0, stride = exemplar.component_count(); t < exemplar.texel_count(); ++t) {
            const double height = decoded(channel, exemplar.texel[t * stride + first]);
            lowest = std::min(lowest, height), highest = std::max(highest, height);
          }
        first += channel.components;
      }
    }
  if (!(highest > lowest)) return;
  component_ = component;
  lowest_ = lowest;
}

double Relief::at(const MaterialPoint& point) const {
  if (!exists()) return 0;
  const Material material = material_at(root_, point);
  return material.coverage * std::max(0.0, double(material.value[component_]) - lowest_);
}

} // namespace pith
