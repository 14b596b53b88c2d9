#pragma once
// The relief of a model's materials: how far its skin stands out.
#include "volume/layer/model.h"

namespace pith {

/// Heights (mm) of the first channel whose meaning is height, above the lowest that any exemplar of the model has, so
/// that none is below 0: relief stands on the root's skin, and a section is nowhere wider than the skin around it.
class Relief {
public:
  /// `root` must outlive it.
  explicit Relief(const Root& root);

  /// Whether any material has heights that differ.
  bool exists() const { return component_ >= 0; }

  /// At a point of the skin; 0 where nothing covers it, and without a relief. One material_at.
  double at(const MaterialPoint& point) const;

private:
  const Root& root_;
  int component_ = -1;
  double lowest_ = 0;
};

} // namespace pith
