#pragma once
// A layer made ready for reading.
#include "volume/layer/layer.h"
#include "volume/layer/sample.h"

namespace pith {

/// A layer with what is needed to read it fast: grids for every mip level, decoding tables, and the corner rows of
/// every look-up side by side (with 3 coordinates in a tet one line of the cache instead of four). Refers to the
/// layer. Memory: 68 bytes per look-up, and per texel 2.3 for each component.
struct LayerReader {
  explicit LayerReader(const Layer& layer, bool mips);

  struct Source {
    std::vector<TexelGrid> level;    ///< finest first
    std::vector<TexelGrid> gaussian; ///< the twins in standard deviations, same levels; empty without
    TexelGrid mean;                  ///< over the axes that Blend::mean_over names, of the finest; unset without
  };
  /// A patch: exemplar coordinates are scale · w + offset (its frame, then the layer's evaluation).
  struct PatchReader {
    Lanes scale{}, offset{};
    const MaskGrid* mask; ///< null: none
    const Source* source;
  };
  const Layer* layer;
  std::vector<Source> source; ///< per exemplar
  std::vector<MaskGrid> mask;
  std::vector<PatchReader> patch;
  std::size_t record_size = 0;        ///< (width + 1) · corners
  LargeArray<float> record;           ///< per look-up, its corner rows
  LargeArray<std::uint32_t> patch_of; ///< per look-up
  int components = 0;
  int height_component = -1; ///< of the first height channel
  bool has_directions = false;
  std::array<bool, max_components> preserved{}; ///< components whose mean and variance mixing preserves

  LayerReader(LayerReader&&) = default; ///< `patch` points into vectors whose memory moves along
  LayerReader(const LayerReader&) = delete;
};

} // namespace pith
