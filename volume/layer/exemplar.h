#pragma once
// An exemplar: the sample of material that look-ups read. An image, a volume, a periodic (s, t, m) tile: 2 to 4 axes.
#include "volume/base/types.h"

#include <string>

namespace pith {

/// What happens outside [0, 1] along an axis.
enum class Wrap : std::uint8_t { clamp, repeat, mirror };

/// How a channel is blended and what it means.
enum class Semantic : std::uint8_t {
  color,     ///< three components, linear Rec.709 once decoded
  scalar,    ///< any number of independent components: roughness, alpha, extinction (1/mm) ...
  height,    ///< one component, mm; drives min/max selection and displacement
  direction, ///< three components: a tangent vector in texture space (fibres); carried to rest space by the inverse
             ///< Jacobian
  normal     ///< three components: a normal in texture space; carried by the Jacobian's transpose
};

/// How a byte of a channel becomes a number: low + (high − low) · byte/255, after the sRGB curve where `srgb`.
struct Channel {
  std::string name = "color";
  Semantic semantic = Semantic::color;
  int components = 3;
  bool srgb = true;
  float low = 0, high = 1;

  bool operator==(const Channel&) const = default;
};

inline constexpr int max_components = 12; ///< of all channels of an exemplar or model together

/// Texels are 8 bit, the first axis fastest, channels interleaved; texel i of an axis of n has its centre at (i +
/// ½)/n.
struct Exemplar {
  std::string name;
  int axes = 3;                        ///< 2, 3 or 4
  std::array<int, 4> size{1, 1, 1, 1}; ///< texels along each axis; 1 beyond `axes`
  std::array<Wrap, 4> wrap{Wrap::clamp, Wrap::clamp, Wrap::clamp, Wrap::clamp};
  std::vector<Channel> channel;
  LargeArray<std::uint8_t> texel; ///< texel_count() · component_count()

  /// Optional, for Blend::Mix::histogram: the same texels made Gaussian (byte b stands for (b/255 − ½) · 6 standard
  /// deviations) and, per component, the 256 decoded values that a Gaussian byte maps back to (Heitz, Neyret 2018).
  LargeArray<std::uint8_t> gaussian;
  LargeArray<float> inverse; ///< component_count() · 256

  std::size_t texel_count() const { return std::size_t(size[0]) * size[1] * size[2] * size[3]; }
  int component_count() const;
  std::uint8_t* at(int x, int y, int z = 0, int w = 0);
  const std::uint8_t* at(int x, int y, int z = 0, int w = 0) const;
};

/// The decoded value of a byte in a channel, and the byte nearest to a value.
float decoded(const Channel& channel, std::uint8_t byte);
std::uint8_t encoded(const Channel& channel, float value);

/// Throws InvalidInput when sizes, channels and texels do not fit together.
void validate(const Exemplar& exemplar);

/// Fills `gaussian` and `inverse` from the texels: each component's values are ranked and mapped to a normal
/// distribution truncated at three standard deviations (Heitz, Neyret 2018, §4). O(n log n).
void make_gaussian_twin(Exemplar& exemplar);

/// The next coarser level: half the size along each axis of more than one texel, averaged in decoded values.
Exemplar half_size(const Exemplar& exemplar);

} // namespace pith
