#pragma once
// A layer: on each simplex a short ordered list of affine look-ups, whoever wrote it.
//
// All methods of pith end in this one representation: lapped solids and lapped surfaces (many masked look-ups, paste
// order), material space (one or three look-ups into a periodic tile), synthesised texture maps (one look-up into an
// atlas with gutters), three-level patches (one look-up per overlapping patch, selection and mixing).
#include "volume/layer/exemplar.h"
#include "volume/layer/mask.h"

namespace pith {

/// What a layer's simplices are.
enum class Domain : std::uint8_t {
  solid, ///< the tets of the root mesh
  skin   ///< the facets of the root's boundary
};

/// How the look-ups of one simplex become one value.
struct Blend {
  enum class Select : std::uint8_t {
    none,
    max, ///< keep those whose weight · height lies within `grace` of the largest (Schuster 2020, §3.4.2)
    min  ///< the same with weight · (1 − height)
  };
  enum class Mix : std::uint8_t {
    over,     ///< later look-ups over earlier ones (paste order)
    weighted, ///< Σ w·c / Σ w; the weights are a partition of unity, so coverage is min(1, Σ w)
    linear,   ///< Σ w·c / Σ w with coverage 1 wherever any weight is positive
    histogram ///< variance-preserving mean of the Gaussian twins, mapped back (Heitz, Neyret 2018)
  };
  Select select = Select::none;
  float grace = 0.1f; ///< in units of height (0..1)
  Mix mix = Mix::over;
  /// Axes along which the exemplars look alike everywhere. Where any is set, mixing preserves mean and variance: with
  /// the shares w of the look-ups that are seen (their sum the coverage C) and the exemplar's mean m over these axes,
  /// C·m + C / √Σw² · Σ w·(c − m) instead of Σ w·c, which lies between the look-ups' colours and so has less contrast
  /// than either (after Heitz, Neyret 2018, eq. 2, about a mean that varies along the other axes). One look-up alone
  /// is shown as it is. Not for Mix::histogram, which preserves them by itself.
  std::array<bool, 4> mean_over{};
  /// How alike look-ups are where they mix, 0 … 1: Σw² above becomes Σw² + correlation · (C² − Σw²), since what is
  /// alike loses no contrast.
  float correlation = 0;

  bool preserves_variance() const { return mean_over[0] || mean_over[1] || mean_over[2] || mean_over[3]; }
};

/// scale · x + offset for each of four axes.
struct AxisMap {
  std::array<float, 4> scale{1, 1, 1, 1};
  std::array<float, 4> offset{0, 0, 0, 0};
};

/// One pasted piece of an exemplar. Coordinates of its look-ups live in the patch's unit cube, where the mask is
/// read; `frame` carries them to the exemplar, so that patches may show different parts of it under the same mask.
struct Patch {
  static constexpr std::uint32_t no_mask = 0xffffffffu;
  std::uint32_t exemplar = 0;
  std::uint32_t mask = no_mask;
  AxisMap frame;
  std::uint64_t key = 0; ///< identifies the paste across edits (a hash of the seed's rest position, say)
};

/// One affine map on one simplex: rows of the layer's corner table, one per corner of the simplex (a facet uses
/// three).
struct Lookup {
  std::uint32_t patch = 0;
  std::array<std::uint32_t, 4> corner{};
};

inline constexpr int max_weighted_lookups = 16; ///< beyond it the smallest are dropped and the rest renormalised

struct Layer {
  std::string name;
  Domain domain = Domain::solid;
  std::int32_t region = -1; ///< the region it belongs to; −1: all
  int width = 3;            ///< coordinates per corner: 2, 3 or 4; equals the axes of its exemplars
  Blend blend;
  std::vector<Exemplar> exemplar; ///< all with the same channels
  std::vector<Mask> mask;
  std::vector<Patch> patch;
  /// Rows of width + 1 numbers: coordinates in the patch's unit cube, then the weight in [0, 1] that multiplies the
  /// mask.
  LargeArray<float> corner;
  /// Exemplar coordinates are evaluation(frame(w)); the mask is read at w itself. Animates m, or moves a layer's
  /// material, without rebuilding it.
  AxisMap evaluation;
  /// Compressed rows: the look-ups of simplex i are lookup[begin[i]] … lookup[begin[i + 1] − 1], in paste order. When
  /// `simplex` is not empty the layer is sparse: row i belongs to simplex[i] (ascending).
  LargeArray<std::uint32_t> begin;
  std::vector<std::uint32_t> simplex;
  LargeArray<Lookup> lookup;

  std::size_t corner_count() const { return corner.size() / (width + 1); }
};

/// Throws InvalidInput, naming the layer and the first offender, unless indices are in range, numbers finite, and
/// exemplars, masks and width agree. `simplex_count`: tets or facets of the root.
void validate(const Layer& layer, std::size_t simplex_count);

} // namespace pith
