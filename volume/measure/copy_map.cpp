#include "volume/measure/copy_map.h"

#include "volume/base/error.h"
#include "volume/base/random.h"
#include "volume/measure/points.h"
#include "volume/measure/sighting.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pith {

CoherentRegions coherent_regions(const Model& model, std::span<const Slice> slices, double pixel_area) {
  CoherentRegions result;
  double sum = 0, squares = 0;
  for (const Slice& s : slices) {
    if (s.source.size() != s.inside.size())
      throw InvalidInput("copy map", "a slice does not tell its sources", "ask for them (SliceOptions::sources)");
    std::vector<std::uint8_t> done(s.inside.size());
    std::vector<std::size_t> stack;
    const auto shows = [&](std::size_t i) { return s.inside[i] && s.source[i].patch != PixelSource::none; };
    for (std::size_t start = 0; start < done.size(); ++start) {
      if (done[start] || !shows(start)) continue;
      double area = 0;
      stack.assign(1, start);
      done[start] = 1;
      while (!stack.empty()) {
        const std::size_t i = stack.back();
        stack.pop_back();
        const double scale = model.field.scale.empty() ? 1 : model.field.scale[s.source[i].tet];
        area += pixel_area / (scale * scale);
        const int x = static_cast<int>(i % s.width()), y = static_cast<int>(i / s.width());
        for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
          if (x + dx < 0 || y + dy < 0 || x + dx >= s.width() || y + dy >= s.height()) continue;
          const std::size_t j = s.index(x + dx, y + dy);
          if (done[j] || !shows(j) || s.source[j].patch != s.source[i].patch ||
              s.source[j].layer != s.source[i].layer)
            continue;
          done[j] = 1;
          stack.push_back(j);
        }
      }
      ++result.regions;
      sum += area;
      squares += area * area;
      result.largest_area = std::max(result.largest_area, area);
    }
  }
  if (result.regions > 0) {
    result.mean_area = sum / static_cast<double>(result.regions);
    result.typical_area = squares / sum;
  }
  return result;
}

SourceUse source_use(const Model& model, const Layer& layer, std::size_t points, int cells, std::uint64_t seed) {
  SourceUse use;
  const VolumePoints source(model.mesh, layer.region);
  if (!(source.volume() > 0) || points == 0) return use;
  const Exemplar& exemplar = layer.exemplar.front();
  const LayerReader reader(layer, false);
  constexpr std::uint32_t none = 0xffffffffu;
  std::vector<std::uint32_t> cell_of(points, none);
  parallel_blocks(points, 2048, [&](std::size_t begin, std::size_t end) {
    Sighting sighting;
    for (std::size_t i = begin; i < end; ++i) {
      const VolumePoint point = source.point(hash_of(seed, 0xc0b9), i);
      look_at(reader, point.tet, point.barycentric, sighting);
      const SeenLookup* top = sighting.dominant();
      if (!top) continue;
      std::uint32_t cell = 0;
      for (int k = 2; k >= 0; --k) {
        double u = top->source[k];
        if (exemplar.wrap[k] == Wrap::repeat) u -= std::floor(u);
        cell = cell * cells + std::clamp(static_cast<int>(u * cells), 0, cells - 1);
      }
      cell_of[i] = cell;
    }
  });
  std::vector<std::size_t> uses(std::size_t(cells) * cells * cells);
  for (const std::uint32_t c : cell_of)
    if (c != none) ++uses[c], ++use.points;

  // Layers: cells that agree along the axes that do not repeat.
  std::vector<std::vector<std::size_t>> layers;
  {
    std::vector<std::size_t> layer_of(uses.size());
    std::size_t count = 1;
    for (int k = 0, stride = 1; k < 3; ++k, stride *= cells) {
      if (exemplar.wrap[k] == Wrap::repeat) continue;
      for (std::size_t c = 0; c < uses.size(); ++c) layer_of[c] = layer_of[c] * cells + (c / stride) % cells;
      count *= cells;
    }
    layers.resize(count);
    for (std::size_t c = 0; c < uses.size(); ++c) layers[layer_of[c]].push_back(uses[c]);
  }
  double entropy = 0, weight = 0, judged = 0, unused = 0;
  WeightedQuantiles peak;
  for (const auto& l : layers) {
    const double all = std::accumulate(l.begin(), l.end(), 0.0), even = all / static_cast<double>(l.size());
    if (!(even >= 8) || l.size() < 2) continue;
    double h = 0;
    for (const std::size_t n : l) {
      if (n > 0) h -= static_cast<double>(n) / all * std::log(static_cast<double>(n) / all);
      judged += 1;
      unused += n == 0;
      peak.add(static_cast<double>(n) / even, 1);
    }
    entropy += all * h / std::log(static_cast<double>(l.size()));
    weight += all;
  }
  if (weight > 0) {
    use.entropy = entropy / weight;
    use.never_used = unused / judged;
    use.most_used = peak.at(0.99);
  }
  return use;
}

} // namespace pith
