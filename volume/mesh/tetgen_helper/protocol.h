#pragma once
// What pith and its TetGen helper say to each other: one problem on the helper's standard input, one result on its
// standard output, both as the structures below followed by their arrays, in the machine's byte order. Both programs
// come from one build.
#include <cstdint>

namespace pith::tetgen_protocol {

inline constexpr std::uint64_t problem_mark = 0x3250'6e65'4774'6554; // changes with the layout
inline constexpr std::uint64_t result_mark = 0x3152'6e65'4774'6554;

/// Followed by points (3 doubles each) and triangles (3 uint32 each) that bound the solid, which TetGen must not
/// change, and by the segments of the core (6 doubles each).
struct Problem {
  std::uint64_t mark = problem_mark;
  std::uint64_t points = 0, triangles = 0, core_segments = 0;
  double core_edge = 0, core_growth = 0; ///< of tets on the core; longer for each mm away from it
  double max_volume = 0;                 ///< of a tet; 0: no bound
  double radius_edge = 0;                ///< bound of circumradius / shortest edge; 0: no refinement
};

/// Followed by `points` points that TetGen added (the problem's come first and keep their numbers) and by tets
/// (4 uint32 each). Written last thing: a result of the right length is whole.
struct Result {
  std::uint64_t mark = result_mark;
  std::uint64_t points = 0, tets = 0;
};

/// Exit codes of the helper.
enum Exit : int {
  done = 0,
  bad_problem = 3,
  tetgen_refused = 4,
  boundary_changed = 5,
  cannot_write = 6,
  no_memory = 7
};

} // namespace pith::tetgen_protocol
