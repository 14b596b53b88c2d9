#pragma once
// A polyline that divides the plane in two: a stroke whose ends go on straight for ever.
#include "volume/base/types.h"

#include <span>
#include <string>
#include <vector>

namespace pith {

/// Nodes of a stroke, prepared for a level set.
struct StrokeNodes {
  std::vector<Vec2d> node;              ///< at least two, on the stroke as it was drawn
  double length = 0;                    ///< of the stroke, screen units
  Vec2d start_direction, end_direction; ///< unit, outwards along the continuations
  bool closed = false;                  ///< a loop: the last node joins the first, and nothing continues
  bool straight = false;                ///< all points lie on one line, within 1e-9 of the length
};

/// Chooses at most `most` nodes on a stroke: its corners (Douglas, Peucker 1973, tolerance from length/500), then
/// points in between at most length/(most/2) apart. Jitter below the tolerance goes. Throws InvalidInput (`where`)
/// when there are fewer than two distinct points or a number is not finite.
StrokeNodes stroke_nodes(std::span<const Vec2d> points, std::size_t most, const std::string& where);

/// The same of a loop, turned so that its inside is on the left. Throws InvalidInput also where it encloses no area.
StrokeNodes loop_nodes(std::span<const Vec2d> points, std::size_t most, const std::string& where);

/// The nodes' polyline with its straight continuations. If the continuations meet, both end there and the divider is
/// a closed curve.
class Divider {
public:
  /// Throws InvalidInput (`where`) when the stroke crosses itself or one of its continuations.
  Divider(const StrokeNodes& nodes, const std::string& where);

  struct Nearest {
    double distance = 0; ///< signed: negative on the left, seen along the direction of drawing
    double beyond = 0;   ///< how far along a continuation the nearest point lies; 0 on the stroke itself
    Vec2d gradient;      ///< of the distance: unit length
    Vec2d outward;       ///< gradient of `beyond`, zero on the stroke itself
  };
  Nearest nearest(const Vec2d& x) const;

  std::size_t node_count() const { return node_.size(); }
  /// Unit normal at a node, to the right: the direction in which the distance grows.
  Vec2d normal(std::size_t i) const { return normal_[i]; }

private:
  struct Part {
    Vec2d from, direction; ///< unit direction of drawing
    double begin, end;     ///< range of the parameter along `direction`; infinite at the ends
    int before, after;     ///< nodes at the ends, −1 at infinity; node_count() where the continuations meet
    int continuation;      ///< −1 before the start, +1 after the end, 0 on the stroke
  };
  std::vector<Vec2d> node_, normal_; ///< normal_ has one more where the continuations meet
  std::vector<Part> part_;
};

} // namespace pith
