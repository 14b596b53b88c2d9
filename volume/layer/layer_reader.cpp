#include "volume/layer/layer_reader.h"

#include "volume/base/parallel.h"

#include <algorithm>

namespace pith {

LayerReader::LayerReader(const Layer& l, bool mips) : layer(&l), components(l.exemplar.front().component_count()) {
  std::array<float, 256> deviations;
  for (int byte = 0; byte < 256; ++byte) deviations[byte] = (byte / 255.0f - 0.5f) * 6;
  const DecodeTable twin_decode(components, deviations);
  for (const Exemplar& finest : l.exemplar) {
    Source s;
    const DecodeTable decode = decode_table(finest);
    const auto add = [&](const Exemplar& e) {
      s.level.push_back(texel_grid(e, e.texel, decode));
      if (!e.gaussian.empty()) s.gaussian.push_back(texel_grid(e, e.gaussian, twin_decode));
    };
    add(finest);
    Exemplar level;
    for (const Exemplar* e = &finest; mips && *std::max_element(e->size.begin(), e->size.end()) > 2; e = &level) {
      level = half_size(*e);
      add(level);
    }
    if (l.blend.preserves_variance()) s.mean = mean_grid(s.level.front(), l.blend.mean_over);
    source.push_back(std::move(s));
  }
  int component = 0;
  for (const Channel& c : l.exemplar.front().channel) {
    if (c.semantic == Semantic::height && height_component < 0) height_component = component;
    const bool directed = c.semantic == Semantic::direction || c.semantic == Semantic::normal;
    has_directions |= directed;
    std::fill_n(preserved.begin() + component, c.components, l.blend.preserves_variance() && !directed);
    component += c.components;
  }
  for (const Mask& m : l.mask) mask.emplace_back(m);
  for (const Patch& p : l.patch) {
    PatchReader reader{.mask = p.mask == Patch::no_mask ? nullptr : &mask[p.mask], .source = &source[p.exemplar]};
    for (int k = 0; k < l.width; ++k) {
      reader.scale[k] = l.evaluation.scale[k] * p.frame.scale[k];
      reader.offset[k] = l.evaluation.scale[k] * p.frame.offset[k] + l.evaluation.offset[k];
    }
    patch.push_back(reader);
  }
  const std::size_t row = l.width + 1, corners = l.domain == Domain::solid ? 4 : 3;
  record_size = row * corners;
  record.resize(l.lookup.size() * record_size + 4); // rows are read four numbers at a time
  patch_of.resize(l.lookup.size());
  parallel_for(l.lookup.size(), 4096, [&](std::size_t i) {
    patch_of[i] = l.lookup[i].patch;
    for (std::size_t k = 0; k < corners; ++k)
      std::copy_n(l.corner.data() + l.lookup[i].corner[k] * row, row, record.data() + i * record_size + k * row);
  });
}

} // namespace pith
