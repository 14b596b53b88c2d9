#pragma once
// A model's layers as three flat tables that a graphics processor reads by index (buffer textures). No GL in here.
//
// `row` holds everything but texels, four 32-bit words a row; floats by their bits. Layer l (bottom first) is at row
// 3·l:
//
//   (domain, region, width, mix | select << 8 | mean << 16 | color << 24)    mean: Blend::mean_over is set;
//   (begin, lookup, patch, corner)                                           color: it has a colour
//   (grace, correlation, patch number, rows a corner)
//
//   begin    first row of the numbers where each simplex's look-ups begin, four a row
//   lookup   a row each: corner numbers
//   patch number   first row of the look-ups' patches, four a row
//   corner   width 2 or 3: (coordinates, 0, weight); width 4: (coordinates), (weight, 0, 0, 0)
//   patch    scale, offset, (source, mask or no_row, 0, 0)
//   source   (levels, first grid, first grid of the Gaussian twin or 0, inverse table or 0), (grid of the mean or 0,
//   …) grid     low, step, (first texel, sizes x, y, z), (size w, wraps, axes, 0)    wraps: two bits an axis (Wrap)
//   inverse  256 rows: colour and height of a Gaussian byte
//   mask     (first alpha, sizes x, y, z), (open axes, axes, 0, 0)
#include "volume/layer/model.h"

namespace pith {

struct MaterialTables {
  static constexpr std::uint32_t no_row = 0xffffffffu;
  static constexpr int header_rows = 3; ///< of a layer

  std::uint32_t layers = 0;
  LargeArray<std::array<std::uint32_t, 4>> row;
  LargeArray<std::array<std::uint16_t, 4>> texel; ///< linear red, green, blue, height; 0 … 65535 between low and high
  LargeArray<std::uint8_t> alpha;                 ///< of the masks, as in Mask

  std::size_t bytes() const { return 16 * row.size() + 8 * texel.size() + alpha.size(); }
};

/// All layers. Colour is the model's first channel of Semantic::color; layers without it keep their coverage. Cost:
/// one pass over look-ups and texels.
MaterialTables material_tables(const Root& root);

} // namespace pith
