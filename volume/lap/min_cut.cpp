#include "volume/lap/min_cut.h"

#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <numeric>

namespace pith {

std::vector<std::uint8_t> min_cut(std::span<const std::int64_t> source, std::span<const std::int64_t> sink,
                                  std::span<const CutEdge> edges) {
  const std::uint32_t nodes = static_cast<std::uint32_t>(source.size()), s = nodes, t = nodes + 1;
  // Every edge with its reverse, side by side: 2i and 2i + 1.
  std::vector<std::uint32_t> from, to;
  std::vector<std::int64_t> capacity;
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::int64_t forth, std::int64_t back) {
    from.insert(from.end(), {a, b});
    to.insert(to.end(), {b, a});
    capacity.insert(capacity.end(), {forth, back});
  };
  for (const CutEdge& e : edges) add(e.a, e.b, e.cost, e.cost);
  for (std::uint32_t i = 0; i < nodes; ++i) {
    if (source[i] > 0) add(s, i, source[i], 0);
    if (sink[i] > 0) add(i, t, sink[i], 0);
  }

  // Compressed rows: place[i] is where edge i goes.
  std::vector<std::uint32_t> begin(nodes + 3, 0), place(from.size());
  for (const std::uint32_t a : from) ++begin[a + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  for (std::size_t i = 0; i < from.size(); ++i) place[i] = begin[from[i]]++;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sorted(from.size());
  std::vector<std::int64_t> sorted_capacity(from.size()), residual(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    sorted[place[i]] = {from[i], to[i]};
    sorted_capacity[place[i]] = capacity[i];
  }

  using Graph = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property,
                                                   boost::no_property, std::uint32_t, std::uint32_t>;
  const Graph graph(boost::edges_are_sorted, sorted.begin(), sorted.end(), nodes + 2);
  using Edge = boost::graph_traits<Graph>::edge_descriptor;
  std::vector<Edge> reverse(from.size());
  for (std::size_t i = 0; i < from.size(); i += 2) {
    reverse[place[i]] = edge_from_index(place[i + 1], graph);
    reverse[place[i + 1]] = edge_from_index(place[i], graph);
  }
  std::vector<Edge> predecessor(nodes + 2);
  std::vector<boost::default_color_type> color(nodes + 2);
  std::vector<std::int64_t> distance(nodes + 2);
  const auto edge_index = get(boost::edge_index, graph);
  const auto node_index = get(boost::vertex_index, graph);
  boost::boykov_kolmogorov_max_flow(graph, boost::make_iterator_property_map(sorted_capacity.begin(), edge_index),
                                    boost::make_iterator_property_map(residual.begin(), edge_index),
                                    boost::make_iterator_property_map(reverse.begin(), edge_index),
                                    boost::make_iterator_property_map(predecessor.begin(), node_index),
                                    boost::make_iterator_property_map(color.begin(), node_index),
                                    boost::make_iterator_property_map(distance.begin(), node_index), node_index, s,
                                    t);
  std::vector<std::uint8_t> kept(nodes);
  for (std::uint32_t i = 0; i < nodes; ++i) kept[i] = color[i] == boost::black_color;
  return kept;
}

} // namespace pith
