#include "viewer/material_tables.h"

#include "volume/base/parallel.h"
#include "volume/layer/tables.h"

#include <bit>

namespace pith {
namespace {

using Row = std::array<std::uint32_t, 4>;

std::uint32_t bits(float number) { return std::bit_cast<std::uint32_t>(number); }
Row row_of(Lanes lanes) { return {bits(lanes[0]), bits(lanes[1]), bits(lanes[2]), bits(lanes[3])}; }

class TableWriter {
public:
  explicit TableWriter(const Root& root) : root_(root) {
    for (const Channel& channel : root.channels()) {
      if (channel.semantic == Semantic::color) {
        color_ = channel.name;
        break;
      }
    }
  }

  MaterialTables tables() {
    const auto& layers = root_.tables().layers;
    out_.layers = static_cast<std::uint32_t>(layers.size());
    out_.row.resize(MaterialTables::header_rows * layers.size());
    for (std::size_t i = 0; i < layers.size(); ++i) add(i, layers[i]);
    return std::move(out_);
  }

private:
  std::uint32_t next_row() const { return static_cast<std::uint32_t>(out_.row.size()); }

  void add(std::size_t index, const Root::Tables::LayerEntry& entry) {
    const LayerReader& reader = entry.reader;
    const Layer& layer = *reader.layer;
    component_ = {-1, -1, -1, reader.height_component};
    int component = 0;
    for (const Channel& channel : layer.exemplar.front().channel) {
      if (channel.name == color_ && channel.components == 3)
        component_ = {component, component + 1, component + 2, reader.height_component};
      component += channel.components;
    }
    const bool skin = layer.domain == Domain::skin;
    const std::size_t simplices = skin ? root_.model().boundary.facet_count() : root_.model().mesh.tet_count();
    const Blend& blend = layer.blend;
    const std::uint32_t rule = std::uint32_t(blend.mix) | std::uint32_t(blend.select) << 8 |
                               std::uint32_t(blend.preserves_variance()) << 16 |
                               std::uint32_t(component_[0] >= 0) << 24;
    const std::uint32_t begin = add_numbers({entry.begin(), simplices + 1});
    const std::uint32_t lookup = next_row();
    for (const Lookup& l : layer.lookup) out_.row.push_back(l.corner);
    const std::uint32_t patch_number = add_numbers({reader.patch_of.data(), reader.patch_of.size()});
    const std::uint32_t corner = next_row();
    add_corners(layer);
    std::vector<std::uint32_t> source, mask;
    for (const LayerReader::Source& s : reader.source) source.push_back(add_source(s));
    for (std::size_t e = 0; e < layer.exemplar.size(); ++e)
      if (blend.mix == Blend::Mix::histogram) out_.row[source[e]][3] = add_inverse(layer.exemplar[e]);
    for (const Mask& m : layer.mask) mask.push_back(add_mask(m));
    const std::uint32_t patch = next_row();
    for (std::size_t p = 0; p < layer.patch.size(); ++p) {
      const Patch& one = layer.patch[p];
      out_.row.push_back(row_of(reader.patch[p].scale));
      out_.row.push_back(row_of(reader.patch[p].offset));
      out_.row.push_back(
          {source[one.exemplar], one.mask == Patch::no_mask ? MaterialTables::no_row : mask[one.mask], 0, 0});
    }
    Row* header = &out_.row[MaterialTables::header_rows * index];
    header[0] = {std::uint32_t(skin), std::uint32_t(layer.region), std::uint32_t(layer.width), rule};
    header[1] = {begin, lookup, patch, corner};
    header[2] = {bits(blend.grace), bits(blend.correlation), patch_number, layer.width == 4 ? 2u : 1u};
  }

  std::uint32_t add_numbers(std::span<const std::uint32_t> number) {
    const std::uint32_t first = next_row();
    out_.row.resize(first + (number.size() + 3) / 4);
    std::copy(number.begin(), number.end(), out_.row.data()[first].data());
    return first;
  }

  void add_corners(const Layer& layer) {
    const std::size_t stride = layer.width + 1;
    for (std::size_t c = 0; c < layer.corner_count(); ++c) {
      const float* row = layer.corner.data() + c * stride;
      if (layer.width == 4) {
        out_.row.push_back({bits(row[0]), bits(row[1]), bits(row[2]), bits(row[3])});
        out_.row.push_back({bits(row[4]), 0, 0, 0});
      } else {
        out_.row.push_back({bits(row[0]), bits(row[1]), layer.width == 3 ? bits(row[2]) : 0, bits(row[layer.width])});
      }
    }
  }

  std::uint32_t add_grid(const TexelGrid& grid) {
    const std::uint32_t first = next_row();
    Row low{}, step{};
    for (int k = 0; k < 4; ++k) {
      const int c = component_[k];
      if (c < 0) continue;
      low[k] = bits(grid.low[c / 4][c % 4]);
      step[k] = bits(65535 * grid.step[c / 4][c % 4]);
    }
    const auto texels = [&](int axis) { return axis < grid.axes ? std::uint32_t(grid.texels[axis]) : 1u; };
    std::uint32_t wraps = 0;
    for (int axis = 0; axis < grid.axes; ++axis) {
      const Wrap wrap = grid.mirrors[axis] ? Wrap::mirror : grid.repeats[axis] ? Wrap::repeat : Wrap::clamp;
      wraps |= std::uint32_t(wrap) << (2 * axis);
    }
    const std::size_t at = out_.texel.size();
    const std::size_t count = std::size_t(texels(0)) * texels(1) * texels(2) * texels(3);
    out_.row.insert(out_.row.end(), {low, step, Row{std::uint32_t(at), texels(0), texels(1), texels(2)},
                                     Row{texels(3), wraps, std::uint32_t(grid.axes), 0}});
    out_.texel.resize(at + count);
    parallel_for(count, 1 << 16, [&](std::size_t i) {
      for (int k = 0; k < 4; ++k)
        out_.texel[at + i][k] = component_[k] < 0 ? 0 : grid.texel[i * grid.components + component_[k]];
    });
    return first;
  }

  std::uint32_t add_source(const LayerReader::Source& source) {
    const std::uint32_t first = next_row();
    out_.row.resize(first + 2);
    const auto add_levels = [&](const std::vector<TexelGrid>& levels) {
      const std::uint32_t row = next_row();
      for (const TexelGrid& grid : levels) add_grid(grid);
      return row;
    };
    const std::uint32_t plain = add_levels(source.level);
    const std::uint32_t gaussian = source.gaussian.empty() ? 0 : add_levels(source.gaussian);
    const std::uint32_t mean = source.mean.texel.empty() ? 0 : add_grid(source.mean);
    out_.row[first] = {std::uint32_t(source.level.size()), plain, gaussian, 0};
    out_.row[first + 1] = {mean, 0, 0, 0};
    return first;
  }

  std::uint32_t add_inverse(const Exemplar& exemplar) {
    const std::uint32_t first = next_row();
    for (int byte = 0; byte < 256; ++byte) {
      Row row{};
      for (int k = 0; k < 4; ++k)
        if (component_[k] >= 0) row[k] = bits(exemplar.inverse[component_[k] * 256 + byte]);
      out_.row.push_back(row);
    }
    return first;
  }

  std::uint32_t add_mask(const Mask& mask) {
    const std::uint32_t first = next_row();
    std::uint32_t open = 0;
    for (int axis = 0; axis < mask.axes; ++axis) open |= std::uint32_t(mask.open[axis]) << axis;
    out_.row.push_back({std::uint32_t(out_.alpha.size()), std::uint32_t(mask.size[0]), std::uint32_t(mask.size[1]),
                        std::uint32_t(mask.size[2])});
    out_.row.push_back({open, std::uint32_t(mask.axes), 0, 0});
    out_.alpha.insert(out_.alpha.end(), mask.alpha.begin(), mask.alpha.end());
    return first;
  }

  const Root& root_;
  std::string color_;
  std::array<int, 4> component_{};
  MaterialTables out_;
};

} // namespace

MaterialTables material_tables(const Root& root) { return TableWriter(root).tables(); }

} // namespace pith
