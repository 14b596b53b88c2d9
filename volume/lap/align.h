#pragma once
// Where in the exemplar a new paste starts, so that it continues what is already pasted: the phase along the
// repeating axes with the least difference where both are seen. Beyond the paper, which leaves misalignment as a
// limitation (§7).
#include "volume/lap/pastes.h"

namespace pith {

/// The exemplar at two or three resolutions, for comparing.
class Aligner {
public:
  /// `structured`: compares wherever the paste overlaps older ones, and searches so finely that joints of a 64th of a
  /// texture width find one another (LapOptions::structured).
  explicit Aligner(const Exemplar& exemplar, bool structured = false);

  /// Offsets of patch.frame along the axes that are `free`, which repeat; `random` stands in where the paste meets
  /// nothing yet, and along the others.
  std::array<float, 4> phase(const Pastes& pastes, const Simplices& mesh, const Paste& paste,
                             const std::array<bool, 3>& free, const std::array<float, 4>& random) const;

private:
  bool structured_;
  std::vector<Exemplar> level_; ///< coarsest first
};

} // namespace pith
