#pragma once
// Marching tetrahedra on three states per corner: below, on, above. Each of the 81 patterns is one of five cases up
// to an even permutation of the corners: whole; tet + prism; two prisms; tet + pyramid; two tets. Prisms and pyramids
// are split by the diagonals through the smallest vertex id of each quadrilateral (Dompierre, Labbé, Vallet,
// Camarero: How to subdivide pyramids, prisms and hexahedra into tetrahedra, 1999): two tets that share a face split
// it alike, no vertex is added, and no choice can contradict another. Every new vertex lies strictly inside its edge,
// so every tet that comes out has a positive volume, wherever on the edges the new vertices are.
#include "volume/base/types.h"

namespace pith {

/// State of a vertex for one cut. A tet's pattern is Σ state(corner i) · 3^i.
enum VertexState : std::uint8_t { state_below = 0, state_on = 1, state_above = 2 };

enum class Split : std::uint8_t {
  whole,  ///< not both signs
  corner, ///< c0 | c1 c2 c3: a tet and a prism; new vertices on 01, 02, 03
  prisms, ///< c0 c1 | c2 c3, c0 and c1 below: two prisms; new vertices on 02, 03, 12, 13
  fan,    ///< c0 on, c1 | c2 c3: a tet and a pyramid; new vertices on 12, 13
  halves  ///< c0 and c1 on, c2 below, c3 above: two tets; a new vertex on 23
};

/// One pattern, brought to its case.
struct Pattern {
  Split split = Split::whole;
  std::array<std::uint8_t, 4> corner = {0, 1, 2, 3}; ///< canonical corner → the tet's corner, an even permutation
  bool lone_above = false;                           ///< corner and fan: the lone corner is the one above
  bool has_below = false, has_above = false;
  std::uint8_t on = 0; ///< how many corners are on
};

/// The edges of each case that get a new vertex, in canonical corners.
struct SplitEdges {
  int count;
  std::array<std::array<std::uint8_t, 2>, 4> corner;
};
inline constexpr std::array<SplitEdges, 5> split_edges = {{{0, {}},
                                                           {3, {{{0, 1}, {0, 2}, {0, 3}, {}}}},
                                                           {4, {{{0, 2}, {0, 3}, {1, 2}, {1, 3}}}},
                                                           {2, {{{1, 2}, {1, 3}, {}, {}}}},
                                                           {1, {{{2, 3}, {}, {}, {}}}}}};

namespace detail {

constexpr Pattern pattern_of_code(int code) {
  std::array<int, 4> state{};
  for (int i = 0, rest = code; i < 4; ++i, rest /= 3) state[i] = rest % 3;

  Pattern pattern;
  std::array<int, 3> count{};
  for (int s : state) ++count[s];
  pattern.has_below = count[state_below] > 0;
  pattern.has_above = count[state_above] > 0;
  pattern.on = static_cast<std::uint8_t>(count[state_on]);
  if (!pattern.has_below || !pattern.has_above) return pattern;

  // The order in which the states appear among the canonical corners; `free` is a pair of corners of one state that
  // may be swapped to make the permutation even.
  std::array<int, 4> wanted{};
  int free = 0;
  if (count[state_on] == 2) {
    pattern.split = Split::halves;
    wanted = {state_on, state_on, state_below, state_above};
  } else if (count[state_on] == 1) {
    pattern.split = Split::fan;
    pattern.lone_above = count[state_above] == 1;
    const int lone = pattern.lone_above ? state_above : state_below;
    wanted = {state_on, lone, 2 - lone, 2 - lone};
    free = 2;
  } else if (count[state_below] == 2) {
    pattern.split = Split::prisms;
    wanted = {state_below, state_below, state_above, state_above};
  } else {
    pattern.split = Split::corner;
    pattern.lone_above = count[state_above] == 1;
    const int lone = pattern.lone_above ? state_above : state_below;
    wanted = {lone, 2 - lone, 2 - lone, 2 - lone};
    free = 1;
  }
  std::array<bool, 4> taken{};
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < 4; ++i)
      if (!taken[i] && state[i] == wanted[k]) {
        taken[i] = true;
        pattern.corner[k] = static_cast<std::uint8_t>(i);
        break;
      }
  int inversions = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) inversions += pattern.corner[i] > pattern.corner[j];
  if (inversions % 2 == 1) {
    const auto swapped = pattern.corner[free];
    pattern.corner[free] = pattern.corner[free + 1];
    pattern.corner[free + 1] = swapped;
  }
  return pattern;
}

constexpr std::array<Pattern, 81> all_patterns() {
  std::array<Pattern, 81> table{};
  for (int code = 0; code < 81; ++code) table[code] = pattern_of_code(code);
  return table;
}

} // namespace detail

inline constexpr std::array<Pattern, 81> patterns = detail::all_patterns();

/// How many tets a pattern makes below and above; {1, 0} or {0, 1} for a whole tet, {0, 0} when all corners are on.
constexpr std::array<int, 2> tets_made(const Pattern& pattern) {
  switch (pattern.split) {
  case Split::corner:
    return pattern.lone_above ? std::array{3, 1} : std::array{1, 3};
  case Split::prisms:
    return {3, 3};
  case Split::fan:
    return pattern.lone_above ? std::array{2, 1} : std::array{1, 2};
  case Split::halves:
    return {1, 1};
  case Split::whole:
    break;
  }
  return {pattern.has_below ? 1 : 0, pattern.has_above ? 1 : 0};
}

/// The points of a tet being split: 0–3 are its canonical corners, 4–7 its new vertices in the order of
/// `split_edges`.
using LocalTet = std::array<std::uint8_t, 4>;

/// Splits the prism with triangles a0 a1 a2 and b0 b1 b2 (edges ai–bi; tet a0 a1 a2 b0 positive) into three tets.
template <class Emit>
void split_prism(const std::array<VertexId, 8>& id, std::array<std::uint8_t, 3> a, std::array<std::uint8_t, 3> b,
                 Emit&& emit) {
  int smallest = 0;
  for (int i = 1; i < 6; ++i)
    if (id[i < 3 ? a[i] : b[i - 3]] < id[smallest < 3 ? a[smallest] : b[smallest - 3]]) smallest = i;
  if (smallest >= 3) { // turn the prism over, so that the smallest id lies in triangle a
    const auto turned = a;
    a = {b[0], b[2], b[1]};
    b = {turned[0], turned[2], turned[1]};
    smallest = smallest == 3 ? 0 : smallest == 4 ? 2 : 1;
  }
  const int i = smallest, j = (i + 1) % 3, k = (i + 2) % 3;
  const auto a0 = a[i], a1 = a[j], a2 = a[k], b0 = b[i], b1 = b[j], b2 = b[k];
  if (std::min(id[a1], id[b2]) < std::min(id[a2], id[b1])) {
    emit(LocalTet{a0, a1, a2, b2});
    emit(LocalTet{a0, a1, b2, b1});
  } else {
    emit(LocalTet{a0, a1, a2, b1});
    emit(LocalTet{a0, b1, a2, b2});
  }
  emit(LocalTet{a0, b1, b2, b0});
}

/// Splits the pyramid over q0 q1 q2 q3 (tet q0 q1 q2 apex positive) into two tets.
template <class Emit>
void split_pyramid(const std::array<VertexId, 8>& id, std::array<std::uint8_t, 4> q, std::uint8_t apex, Emit&& emit) {
  const int turn = std::min(id[q[0]], id[q[2]]) < std::min(id[q[1]], id[q[3]]) ? 0 : 1;
  const auto at = [&](int i) { return q[(i + turn) % 4]; };
  emit(LocalTet{at(0), at(1), at(2), apex});
  emit(LocalTet{at(0), at(2), at(3), apex});
}

/// Calls emit(above, local tet) for every tet that a crossed tet becomes; `id` holds the vertex ids of the local
/// points. Precondition: pattern.split is not `whole`.
template <class Emit>
void split_tet(const Pattern& pattern, const std::array<VertexId, 8>& id, Emit&& emit) {
  const bool lone = pattern.lone_above, rest = !lone;
  const auto to = [&](bool above) { return [&emit, above](const LocalTet& tet) { emit(above, tet); }; };
  switch (pattern.split) {
  case Split::corner:
    emit(lone, LocalTet{0, 4, 5, 6});
    split_prism(id, {4, 5, 6}, {1, 2, 3}, to(rest));
    break;
  case Split::prisms:
    split_prism(id, {0, 4, 5}, {1, 6, 7}, to(false));
    split_prism(id, {2, 4, 6}, {3, 5, 7}, to(true));
    break;
  case Split::fan:
    emit(lone, LocalTet{0, 1, 4, 5});
    split_pyramid(id, {5, 3, 2, 4}, 0, to(rest));
    break;
  case Split::halves:
    emit(false, LocalTet{0, 1, 2, 4});
    emit(true, LocalTet{0, 1, 4, 3});
    break;
  case Split::whole:
    break;
  }
}

/// Bit k (0–3): the point lies on the face opposite canonical corner k. Bit 4: it lies on the section.
inline constexpr std::uint8_t on_section = 16;
constexpr std::array<std::uint8_t, 8> point_masks(const Pattern& pattern) {
  std::array<std::uint8_t, 8> mask{};
  for (int i = 0; i < 4; ++i) mask[i] = static_cast<std::uint8_t>(15 ^ (1 << i));
  if (pattern.split == Split::fan || pattern.split == Split::halves) mask[0] |= on_section;
  if (pattern.split == Split::halves) mask[1] |= on_section;
  const SplitEdges& edges = split_edges[static_cast<int>(pattern.split)];
  for (int e = 0; e < edges.count; ++e)
    mask[4 + e] =
        static_cast<std::uint8_t>(on_section | (15 ^ (1 << edges.corner[e][0]) ^ (1 << edges.corner[e][1])));
  return mask;
}

} // namespace pith
