#pragma once
// The seven kinds of solid texture by anisotropy (0–2) and variation (0–3) (Takayama 2008, §3, Fig. 3).
#include "volume/base/types.h"

#include <optional>
#include <string>

namespace pith {

/// Named anisotropy-variation as in the paper (a: none, b: along one axis, c: two, d: three). The paper builds those
/// up to 2-b.
enum class TextureType : std::uint8_t {
  isotropic_0, ///< looks alike from everywhere: every paste is turned at random
  axis_1a,     ///< one axis (fibres): T follows strokes, every paste is turned around it at random
  axis_1b,     ///< layers: S is depth, the second coordinate; every paste is turned around it at random
  tensor_2a,   ///< three different axes, the same everywhere
  tensor_2b,   ///< three different axes, changing along depth, which is the texture's second coordinate
  tensor_2c,   ///< changing along two: depth and `along` are coordinates 1 and 2; tiles around both
  tensor_2d    ///< changing along all three: nothing tiles, one map covers the region
};

inline constexpr int texture_type_count = 7;

/// Which axes of the exemplar (0 = R, 1 = S, 2 = T) the type ties down, and by what.
struct TextureTraits {
  const char* name; ///< "2-b"
  int fixed_axes;   ///< 0: none, 1: one, 3: all of a frame's axes are given by the field
  int fixed_axis;   ///< where fixed_axes is 1: which; the rest is chosen at random per paste
  /// Coordinates that are scalar fields over the solid instead of being solved for; the others must tile.
  std::array<bool, 3> imposed;
  bool uses_depth;  ///< S follows the depth field
  bool uses_stroke; ///< T follows strokes
  bool uses_scale;  ///< millimetres per texture width are given; else they are 1/|∇d| (§5.2.7)
};

const TextureTraits& traits_of(TextureType type);

/// The type of a name ("2-b"), or none.
std::optional<TextureType> texture_type_of(const std::string& name);

/// "R", "S", "T".
char axis_letter(int axis);

} // namespace pith
