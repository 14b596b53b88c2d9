#pragma once
// Many things of one kind, placed by a rule: a kiwi's seeds, nuts in a cake. Each is pasted as by hand (paste.h):
// whole, apart from all others.
#include "volume/base/parallel.h"
#include "volume/lap/paste.h"

namespace pith {

struct ScatterOptions {
  int count = 0;                     ///< how many; 0: as many as `spacing` lets in
  double spacing = 0;                ///< mm: least distance between middles; 0: only that things do not touch
  double gap = 0;                    ///< mm: least distance between the boxes around things
  double size = 1;                   ///< mm, as PasteOptions::size
  double size_variation = 0;         ///< sizes are uniform in size · (1 ± this); 0 … 0.9
  std::array<double, 2> depth{0, 1}; ///< where the middles may lie; other than 0 … 1 needs a depth field

  /// The line that `along` and `groups` count from and around.
  std::array<Vec3d, 2> axis{Vec3d::Zero(), Vec3d::UnitZ()};
  std::array<double, 2> along{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  ///< parts of the way from axis[0] (0) to axis[1] (1)
  int groups = 0;           ///< equal sectors around the axis, things in the middle of each (locules); 0: all around
  double group_width = 0.6; ///< the part of a sector that is used

  Mat3d rotation = Mat3d::Identity(); ///< as PasteOptions
  bool in_frame = true;
  double jitter = 0; ///< radians: each is tilted about some axis by up to this
  double spin = 0;   ///< radians: each is turned about its second axis (S) by up to this, either way
  Follow follow = Follow::rigid;
  bool clip = false; ///< may reach out of the region
  std::uint64_t seed = 1;
};

struct ScatterGround {
  PasteGround paste;
  std::span<const float> depth; ///< per vertex, 0 … 1; may be empty
};

struct ScatterResult {
  std::vector<PastedThing> pasted; ///< in order of priority
  int wanted = 0;                  ///< count; where it was 0, as many as were placed
};

/// Candidates are the points of a jittered lattice of rest space; they are tried in an order hashed from their place,
/// and one is kept when it lies where the rule allows, its thing wholly inside the region (unless `clip`), and its
/// box clear of all kept ones and of `taken`. So a change somewhere moves only things near by, and a larger count
/// adds to those of a smaller one. The same for any number of threads. Errors: InvalidInput, at `where`, for options
/// out of range, and when nothing finds room. Cost: ~0.1 µs per candidate (some tens for each thing), 10 µs per
/// thing.
ScatterResult scatter(const ScatterGround& ground, const Thing& thing, const ScatterOptions& options,
                      std::span<const PlacedBox> taken, const std::string& where, const Progress& progress = {});

} // namespace pith
