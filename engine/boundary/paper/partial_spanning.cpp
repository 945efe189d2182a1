// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/partial_spanning.hpp"

#include "engine/boundary/paper/cycles.hpp"
#include "engine/boundary/paper/order_edges.hpp"
#include "engine/stitch/union_find.hpp"

#include <numeric>

namespace lacuna::paper {

PartialSpanning span_partially(const KnownVertices& vertices, std::vector<WeightedEdge> edges, std::int64_t e,
                               Scratch& scratch) {
  std::vector<LocalIndex> foreign(vertices.size() - vertices.owned);
  std::iota(foreign.begin(), foreign.end(), vertices.owned);
  order_edges(edges, vertices.ids);
  Spanning spanning(vertices.ids, e, scratch, foreign);
  std::vector<WeightedEdge> undecided;
  std::vector<std::uint8_t> is_open(vertices.size());
  std::erase_if(edges, [&](const WeightedEdge& edge) {
    const EdgeDecision decision = spanning.add({edge.a, edge.b});
    if (decision == EdgeDecision::undecided) undecided.push_back(edge);
    // The other part may report it without knowing the path that excludes it: the path is passed on, too.
    if (decision == EdgeDecision::left_out && !vertices.reports(edge)) is_open[edge.a] = 1;
    return decision != EdgeDecision::taken;
  });
  const std::span<LocalIndex> links = scratch.array<LocalIndex>(vertices.size());
  UnionFind connected(links);
  for (const WeightedEdge& edge : edges) connected.unite(edge.a, edge.b);
  for (const WeightedEdge& edge : undecided) connected.unite(edge.a, edge.b);

  std::vector<LocalIndex> open;
  for (LocalIndex v = 0; v < vertices.size(); ++v) {
    if (is_open[v] || spanning.is_open(v)) open.push_back(v);
  }
  const PartCycles cycles = split_cycles(spanning.finish(), open, scratch);
  const auto is_not_wanted = [&](const WeightedEdge& edge) {
    return !cycles.leads_out[edge.a] || !cycles.leads_out[edge.b] || !vertices.reports(edge);
  };
  std::erase_if(edges, is_not_wanted);
  std::erase_if(undecided, is_not_wanted);
  return {cycles.complete, std::move(edges), std::move(undecided), links};
}

}  // namespace lacuna::paper
