#pragma once
// Small square windows into a model, each with windows of the same cut through the exemplar: what the slice metric
// compares. A window follows the texture's frame at its centre, so that both sides show one scale and orientation.
#include "volume/base/random.h"
#include "volume/measure/points.h"
#include "volume/measure/slice.h"

#include <functional>
#include <optional>

namespace pith {

/// How a window lies in the texture's frame.
enum class SliceClass : std::uint8_t {
  across_r, ///< at right angles to R: right is T, down is S
  across_s, ///< along a layer of one depth: right is R, down is T
  across_t, ///< right is R, down is S
  oblique   ///< turned at random
};
inline constexpr std::array<SliceClass, 4> slice_classes{SliceClass::across_r, SliceClass::across_s,
                                                         SliceClass::across_t, SliceClass::oblique};

struct WindowOptions {
  int windows = 192;
  int pixels = 32;      ///< along each side
  double extent = 0.35; ///< of a side, texture widths; not above 0.35, so that half an exemplar holds a window
  std::uint64_t seed = 1;
  /// Pixels are left out where depth differs by more than this from what the exemplar's window has there.
  double depth_tolerance = 0.06;
  /// Pixels are left out where the frame has turned by more than this (radians) or the scale changed by more than
  /// this factor since the window's centre: there the window no longer shows the texture as it is; ∞: none is left
  /// out.
  double turn_tolerance = 0.35, scale_tolerance = 1.35;
  std::function<bool(TetId)> takes{}; ///< only windows around points of such tets; none: all
  double largest_mm = 0;              ///< of a side; 0: any
};

/// Window i of each set shows the same cut, at the same depth, and the same pixels are inside in all four.
struct WindowSets {
  std::vector<Slice> model;                   ///< with sources
  std::vector<Slice> exemplar;                ///< anywhere along the axes that repeat
  std::vector<Slice> first_half, second_half; ///< within either half of the exemplar along `split_axis`
  int split_axis = -1;                        ///< the first axis that repeats; −1: there is none, and no halves
  bool depth_varying = false;                 ///< coordinate 1 is the depth
  std::size_t pixels = 0, pixels_left = 0;    ///< of all windows; and those that stay inside
};

/// True when the layer's second coordinate is the model's depth: at nine of ten look-ups the two agree within 10⁻³.
bool varies_with_depth(const Model& model, const Layer& layer);

/// Pixels are also left out where layers above show: seeds on a flesh are not in its exemplar. Precondition: the
/// layer is solid, of the model (one of root.model().layer), and 3 wide. Where the model has no frames, those of the
/// look-ups stand in. Empty where `takes` leaves nothing. In parallel; a function of the options alone.
WindowSets windows_of(const Root& root, const Layer& layer, SliceClass slice_class, const WindowOptions& options,
                      const Progress& progress = {});

} // namespace pith
