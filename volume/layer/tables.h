#pragma once
// What Root keeps beside its model. Included by the files that evaluate it, not by their users.
#include "volume/layer/composite.h"
#include "volume/layer/model.h"

namespace pith {

struct Root::Tables {
  Tables(Model model, const RootOptions& options);

  struct LayerEntry {
    LayerReader reader;
    std::vector<int> component; ///< of the root, for each component of the layer
    /// Where each simplex's look-ups begin, one entry more than simplices: of a sparse layer; a dense one has its
    /// own.
    LargeArray<std::uint32_t> dense_begin;

    const std::uint32_t* begin() const {
      return dense_begin.empty() ? reader.layer->begin.data() : dense_begin.data();
    }
    std::span<const Lookup> row(std::uint32_t simplex) const {
      const Lookup* lookup = reader.layer->lookup.data();
      return {lookup + begin()[simplex], lookup + begin()[simplex + 1]};
    }
  };
  Model model;
  Locator locator; ///< refers to model
  std::vector<Channel> channels;
  int components = 0;
  std::vector<LayerEntry> layers; ///< refer to model
  std::vector<int> directions;    ///< first components of direction and normal channels
};

} // namespace pith
