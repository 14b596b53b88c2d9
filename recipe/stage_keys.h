#pragma once
// The options of each stage as parts of a key: every field that can change the result, none that cannot.
#include "recipe/key.h"
#include "recipe/recipe.h"

namespace pith {

KeyMaker& add(KeyMaker& maker, const TetrahedralizeOptions& options);
KeyMaker& add(KeyMaker& maker, const std::vector<DepthConstraint>& constraints);
KeyMaker& add(KeyMaker& maker, const DepthOptions& options);
KeyMaker& add(KeyMaker& maker, const std::vector<AxisStroke>& strokes);
KeyMaker& add(KeyMaker& maker, const std::vector<ScaleConstraint>& constraints);
KeyMaker& add(KeyMaker& maker, const FrameOptions& options);
KeyMaker& add(KeyMaker& maker, const LapOptions& options);
KeyMaker& add(KeyMaker& maker, const DivideStep& step); ///< without its surface
KeyMaker& add(KeyMaker& maker, const SplotchOptions& mask);
KeyMaker& add(KeyMaker& maker, const PasteStep& step);   ///< without its thing
KeyMaker& add(KeyMaker& maker, const ScatterStep& step); ///< without its thing
KeyMaker& add(KeyMaker& maker, const CutStep& step);     ///< without its surface, and what a depth stands on
KeyMaker& add(KeyMaker& maker, const MoveStep& step);

} // namespace pith
