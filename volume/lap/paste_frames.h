#pragma once
// The frames that a single paste follows: those of the field, completed where the texture's type leaves axes free
// (Takayama 2008, §5.2.2: "the other direction is chosen randomly when pasting each patch").
#include "volume/base/random.h"
#include "volume/base/types.h"

#include <span>

namespace pith {

/// Frames per simplex, and what of them counts.
struct FrameSource {
  std::span<const Mat3d> axes; ///< per simplex: unit columns R, S, T; ignored where nothing is fixed
  int fixed_axes = 3;          ///< 0: none, 1: `fixed_axis` alone, 3: all
  int fixed_axis = 2;
  bool unsigned_axis = false; ///< T and −T are the same: neighbouring frames may be turned over to agree
};

/// A frame for a paste whose seed is `seed`: the field's own; turned around its fixed axis by a random angle; or any
/// rotation, all equally likely.
Mat3d seed_frame(const FrameSource& source, std::uint32_t seed, Random& random);

/// Frames of one paste. A free axis is carried along from the seed by the smallest turn that takes the seed's fixed
/// axis to the simplex', so that the frames of a clump are as parallel as the field allows.
class PasteFrames {
public:
  PasteFrames(const FrameSource& source, const Mat3d& seed) : source_(source), seed_(seed) {}

  /// The frame on a simplex.
  Mat3d at(std::uint32_t simplex) const;

  /// Cosine of the angle between what is fixed on the simplex and at the seed: between the axes, or of the turn
  /// between the frames; 1 where nothing is fixed.
  double cosine(std::uint32_t simplex) const;

  const Mat3d& seed() const { return seed_; }

private:
  FrameSource source_;
  Mat3d seed_;
};

} // namespace pith
