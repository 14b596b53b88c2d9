#pragma once
// Square patches of pictures as points of a space, and exact nearest neighbours among them.
#include "volume/measure/slice.h"

#include <span>

namespace pith {

/// Patches of `side` × `side` pixels, three numbers (sRGB-encoded, 0 … 1) each: rows of a table, with a band each.
struct PatchTable {
  int dimension = 0; ///< side² · 3
  std::vector<float> value;
  std::vector<std::int32_t> band;

  std::size_t count() const { return band.size(); }
  std::span<const float> row(std::size_t i) const { return {value.data() + i * dimension, std::size_t(dimension)}; }
};

/// Half the size along both axes: the mean of 2 × 2 pixels, in linear light; inside where all four are. An odd last
/// row or column is dropped.
Slice half_size(const Slice& slice);

/// All patches that lie wholly inside, of all slices in their order, thinned evenly to at most `most`; the band is
/// that of the middle pixel's depth, of `bands` equal ones.
PatchTable patches_of(std::span<const Slice> slices, int side, int bands, std::size_t most);

/// For each query the Euclidean distance to the nearest row of `table` in the same band, divided by √dimension (so
/// that two flat patches that differ by c in every number are c apart); −1 where the band has none. Exact: both are
/// turned by the table's principal components, the search goes outwards along the first and adds up the others until
/// what is found is beaten. In parallel.
std::vector<float> nearest_distances(const PatchTable& query, const PatchTable& table);

} // namespace pith
