// Simplification of a scalar field by flooding. What is levelled: extrema by their persistence (Edelsbrunner,
// Letscher, Zomorodian: Topological persistence and simplification, 2002), those that constraints hold excepted
// (Tierny, Pascucci: Generalized topological simplification of scalar fields on surfaces, 2012). How: Priority-Flood
// with a slope (Barnes, Lehman, Mulla: Priority-Flood, 2014, algorithm 3), from the held vertices.
//
// Departures: basins that do not persist keep their depths, and the slope is per length and bounded in all, so that
// the dead end of a levelled place is no new extremum.
#include "volume/field/depth_flood.h"

#include <algorithm>
#include <queue>

namespace pith {
namespace {

/// Of levelled places, over the extent of the region: frames take less than 0.02 for no rise (FrameOptions).
constexpr double slope_by_extent = 0.024;
/// No levelled place rises by more, in persistences; halved from round to round.
constexpr double largest_rise = 0.95;
/// Extrema that just do not persist may do so beside a levelled place; a second round is rare.
constexpr int most_rounds = 16;

/// Depth from one side: a height whose minima are raised.
struct Side {
  bool maxima;
  float height(float depth) const { return maxima ? -depth : depth; }
  float depth(float height) const { return maxima ? -height : height; }
};

/// The vertices below the places where basins spill over. O(n).
PerVertex<std::uint8_t> basins(const DepthGraph& graph, const PerVertex<float>& depth, const Side& side,
                               std::vector<DepthExtremum> extrema) {
  // A basin within another one spills over below it.
  const auto spill_of = [&](const DepthExtremum& extremum) { return side.height(depth[extremum.saddle]); };
  std::sort(extrema.begin(), extrema.end(), [&](const DepthExtremum& a, const DepthExtremum& b) {
    return spill_of(a) != spill_of(b) ? spill_of(a) > spill_of(b) : a.vertex.value < b.vertex.value;
  });
  PerVertex<std::uint8_t> basin(depth.size(), 0);
  std::vector<VertexId> open;
  for (const DepthExtremum& extremum : extrema) {
    if (basin[extremum.vertex]) continue;
    const float spill = spill_of(extremum);
    basin[extremum.vertex] = 1;
    open.push_back(extremum.vertex);
    while (!open.empty()) {
      const VertexId v = open.back();
      open.pop_back();
      for (const VertexId n : graph.neighbors[v])
        if (!basin[n] && side.height(depth[n]) < spill) {
          basin[n] = 1;
          open.push_back(n);
        }
    }
  }
  return basin;
}

/// How far a levelled place rises over a length: at first by the slope, at last by `most`.
struct Rise {
  double slope, most;
  double over(double length) const { return length > 0 ? most * slope * length / (most + slope * length) : 0; }
};

/// A vertex that the flood reaches at `level`, after a length over levelled places.
struct Front {
  float level;
  VertexId vertex;
  double length;
  bool operator>(const Front& other) const {
    return level != other.level ? level > other.level : vertex.value > other.vertex.value;
  }
};

enum class State : std::uint8_t { dry, as_it_was, raised, done };

/// Raises what the flood from the held vertices finds in basins.
void flood(const DepthGraph& graph, const PerVertex<std::uint8_t>& held, const PerVertex<std::uint8_t>& basin,
           const Side& side, const Rise& rise, PerVertex<float>& depth) {
  std::priority_queue<Front, std::vector<Front>, std::greater<>> fronts;
  PerVertex<State> state(depth.size(), State::dry);
  for (const VertexId v : graph.vertex)
    if (held[v]) {
      state[v] = State::as_it_was;
      fronts.push({side.height(depth[v]), v, 0});
    }
  while (!fronts.empty()) {
    const Front at = fronts.top();
    fronts.pop();
    if (state[at.vertex] == State::done) continue;
    const bool raised = state[at.vertex] == State::raised;
    state[at.vertex] = State::done;
    if (raised) depth[at.vertex] = side.depth(at.level);
    for (const VertexId n : graph.neighbors[at.vertex]) {
      if (state[n] == State::as_it_was || state[n] == State::done) continue;
      const float height = side.height(depth[n]);
      if (height > at.level) {
        state[n] = State::as_it_was;
        fronts.push({height, n, 0});
      } else if (basin[n] || raised) {
        const double length = at.length + (graph.mesh.position[n] - graph.mesh.position[at.vertex]).norm();
        const double level = at.level + (rise.over(length) - rise.over(at.length));
        state[n] = State::raised;
        fronts.push({static_cast<float>(level), n, length});
      } else { // a dip that does not persist
        state[n] = State::as_it_was;
        fronts.push({at.level, n, 0});
      }
    }
  }
}

} // namespace

LevelledDepth without_extrema(const DepthGraph& graph, const PerVertex<float>& depth,
                              const PerVertex<std::uint8_t>& held, double persistence) {
  Box box;
  for (const VertexId v : graph.vertex) box.add(graph.mesh.position[v]);
  LevelledDepth result{.depth = depth, .slope = box.empty() ? 0 : slope_by_extent / box.extent().maxCoeff()};
  Rise rise{.slope = result.slope, .most = largest_rise * persistence};
  bool found = true;
  for (int round = 0; found && round < most_rounds; ++round, rise.most /= 2) {
    found = false;
    for (const Side side : {Side{false}, Side{true}}) {
      std::vector<DepthExtremum> extrema = extrema_of(graph, result.depth, held, side.maxima, persistence);
      std::erase_if(extrema, [](const DepthExtremum& e) { return !e.saddle.exists(); });
      if (extrema.empty()) continue;
      found = true;
      flood(graph, held, basins(graph, result.depth, side, extrema), side, rise, result.depth);
    }
  }
  return result;
}

} // namespace pith
