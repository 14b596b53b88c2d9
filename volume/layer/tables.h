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
  };
  Model model;
  Locator locator; ///< refers to model
  std::vector<Channel> channels;
  int components = 0;
  std::vector<LayerEntry> layers; ///< refer to model
  std::vector<int> directions;    ///< first components of direction and normal channels
};

} // namespace pith
