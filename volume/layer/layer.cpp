#include "volume/layer/layer.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>

namespace pith {

void validate(const Layer& layer, std::size_t simplex_count) {
  const auto refuse = [&](const std::string& what, const std::string& mend) {
    throw InvalidInput("layer '" + layer.name + "'", what, mend);
  };
  if (layer.width < 2 || layer.width > 4)
    refuse("has coordinates " + std::to_string(layer.width) + " wide", "give 2, 3 or 4");
  if (layer.exemplar.empty()) refuse("has no exemplar", "give at least one");
  for (const Exemplar& e : layer.exemplar) {
    validate(e);
    if (e.axes != layer.width)
      refuse("is " + std::to_string(layer.width) + " wide but exemplar '" + e.name + "' has " +
                 std::to_string(e.axes) + " axes",
             "make them equal");
    if (e.channel != layer.exemplar.front().channel)
      refuse("mixes exemplars of different channels", "give every exemplar of a layer the same channels");
    if (layer.blend.mix == Blend::Mix::histogram && e.gaussian.empty())
      refuse("blends by histogram but exemplar '" + e.name + "' has no Gaussian twin", "call make_gaussian_twin");
  }
  if (!(layer.blend.correlation >= 0 && layer.blend.correlation <= 1))
    refuse("mixes with a correlation of " + std::to_string(layer.blend.correlation), "give 0 to 1");
  if (layer.blend.preserves_variance() && layer.blend.mix == Blend::Mix::histogram)
    refuse("preserves variance twice: by histogram and by mean_over", "clear mean_over, or mix otherwise");
  if (layer.blend.select != Blend::Select::none) {
    const auto& channels = layer.exemplar.front().channel;
    if (std::none_of(channels.begin(), channels.end(),
                     [](const Channel& c) { return c.semantic == Semantic::height; }))
      refuse("selects by height but its exemplars have none", "add a height channel or select none");
    if (layer.blend.mix == Blend::Mix::over || !(layer.blend.grace > 0))
      refuse("selects by height without a mix of weights or with a grace of 0", "mix linear or histogram, grace > 0");
  }
  for (const Mask& m : layer.mask)
    if (m.axes < 2 || m.axes > std::min(3, layer.width) ||
        m.alpha.size() != std::size_t(m.size[0]) * m.size[1] * m.size[2] || m.alpha.empty())
      refuse("has a mask whose size and alpha do not agree", "give size[0] · size[1] · size[2] bytes");
  const auto finite = [](const AxisMap& map) {
    return std::all_of(map.scale.begin(), map.scale.end(), [](float x) { return std::isfinite(x); }) &&
           std::all_of(map.offset.begin(), map.offset.end(), [](float x) { return std::isfinite(x); });
  };
  if (!finite(layer.evaluation)) refuse("has an evaluation that is not finite", "check the author that made it");
  for (const Patch& p : layer.patch) {
    if (!finite(p.frame)) refuse("has a patch whose frame is not finite", "check the author that made it");
    if (p.exemplar >= layer.exemplar.size())
      refuse("has a patch of an exemplar that does not exist", "number them from 0");
    if (p.mask != Patch::no_mask && p.mask >= layer.mask.size())
      refuse("has a patch of a mask that does not exist", "number them from 0");
  }
  if (layer.corner.size() % (layer.width + 1) != 0)
    refuse("has a broken corner table", "give rows of width + 1 numbers");
  for (float c : layer.corner)
    if (!std::isfinite(c)) refuse("has a coordinate or weight that is not finite", "check the author that made it");
  const std::size_t rows = layer.simplex.empty() ? simplex_count : layer.simplex.size();
  if (layer.begin.size() != rows + 1 || layer.begin.front() != 0 || layer.begin.back() != layer.lookup.size() ||
      !std::is_sorted(layer.begin.begin(), layer.begin.end()))
    refuse("has rows that do not fit its look-ups",
           "give begin one entry more than rows, ascending, ending at the count");
  for (std::size_t i = 0; i < layer.simplex.size(); ++i)
    if (layer.simplex[i] >= simplex_count || (i > 0 && layer.simplex[i] <= layer.simplex[i - 1]))
      refuse("names simplices out of range or out of order",
             "give ascending ids below " + std::to_string(simplex_count));
  const std::size_t corners = layer.corner_count();
  const int used = layer.domain == Domain::solid ? 4 : 3;
  for (const Lookup& l : layer.lookup) {
    if (l.patch >= layer.patch.size()) refuse("has a look-up of a patch that does not exist", "number them from 0");
    for (int i = 0; i < used; ++i)
      if (l.corner[i] >= corners)
        refuse("has a look-up past the end of its corner table", "check the author that made it");
  }
}

} // namespace pith
