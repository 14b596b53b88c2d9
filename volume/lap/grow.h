#pragma once
// Growing a clump of simplices around a seed while they follow the seed's frame and lie under the mask
// (Takayama 2008, §5.2.4; Praun 2000, §3).
#include "volume/lap/paste_frames.h"
#include "volume/lap/warp.h"
#include "volume/layer/mask.h"

#include <limits>

namespace pith {

/// What pastes follow.
struct GrowField {
  FrameSource frames;
  std::span<const float> scale;          ///< per simplex: mm per texture width
  std::array<double, 3> extent{1, 1, 1}; ///< texture widths that the mask's unit cube spans along each axis
  /// Per vertex: becomes that coordinate as it is (extent 1); empty: the coordinate is solved for.
  std::array<std::span<const float>, 3> coordinate{};
  std::span<const float> length_weight{};   ///< per simplex, of the warp (Clump::length_weight); may be empty
  std::span<const std::uint8_t> singular{}; ///< per simplex: its frame means nothing; may be empty
  std::span<const std::uint8_t> pivot{};    ///< per vertex: frames turn around it (pivots.h); may be empty
};

struct GrowRule {
  Mat3d seed_frame = Mat3d::Identity(); ///< the seed's, of seed_frame()
  double frame_tolerance = 1.1;         ///< radians; simplices that turn further from the seed's frame are left out
  double scale_tolerance = std::numeric_limits<double>::infinity(); ///< and those whose scale differs by this factor
  /// Radians, above frame_tolerance: simplices that turn no further from the seed's frame are taken all the same,
  /// with little confidence; above π: all of them, and the piece fades nowhere.
  double reach = 0;
  bool mirrored = false; ///< keep simplices that end up in mirror image
};

/// Memory that is used again from paste to paste: which simplices and vertices are in the clump.
class GrowWorkspace {
public:
  void begin(std::size_t simplices, std::size_t vertices);
  std::uint32_t local_simplex(std::uint32_t s) const {
    return simplex_stamp_[s] == stamp_ ? simplex_[s] : Simplices::none;
  }
  std::uint32_t local_vertex(std::uint32_t v) const {
    return vertex_stamp_[v] == stamp_ ? vertex_[v] : Simplices::none;
  }
  void set_simplex(std::uint32_t s, std::uint32_t local) { simplex_stamp_[s] = stamp_, simplex_[s] = local; }
  void set_vertex(std::uint32_t v, std::uint32_t local) { vertex_stamp_[v] = stamp_, vertex_[v] = local; }

private:
  std::uint32_t stamp_ = 0;
  std::vector<std::uint32_t> simplex_, vertex_, simplex_stamp_, vertex_stamp_;
};

/// A grown and warped clump.
struct Growth {
  Clump clump;
  std::vector<float> weight; ///< per clump vertex: 0 where growth stopped under the mask (but at pivots), else 1
  int warp_iterations = 0;
};

/// Grows from `seed`, whose point `pin_barycentric` goes to `pin` (in the mask's unit cube), warps, and grows again
/// while the warped mask reaches past the clump (§5.2.5, last paragraph). Singular simplices join every clump that
/// reaches them, with little confidence, but none grows through them to frames that turn from the seed's: a piece
/// ends at a singular axis, and simplices that the warp leaves in mirror image are given back. Beyond the paper,
/// whose pieces lie across the axis and are folded there.
Growth grow(const Simplices& mesh, const GrowField& field, const Mask& mask, std::uint32_t seed,
            const std::array<double, 3>& pin, const std::array<float, 4>& pin_barycentric, const GrowRule& rule,
            GrowWorkspace& workspace);

} // namespace pith
