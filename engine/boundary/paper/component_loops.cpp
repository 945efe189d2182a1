// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/component_loops.hpp"

#include "engine/boundary/paper/cycles.hpp"
#include "engine/boundary/paper/loops.hpp"
#include "engine/boundary/paper/spanning.hpp"
#include "engine/store/row_numbers.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <tuple>

namespace lacuna::paper {
namespace {

// An edge between numbered vertices, in the order in which the spanning graph takes edges.
struct OrderedEdge {
  double weight;
  PointId low, high;  // ids of its ends
  LocalIndex a, b;

  friend bool operator<(const OrderedEdge& x, const OrderedEdge& y) {
    return std::tie(x.weight, x.low, x.high) < std::tie(y.weight, y.low, y.high);
  }
};

}  // namespace

// Vertices are numbered by row: near in space, near in memory.
void find_component_loops(const Stitch<BoundaryEdge>::ForEachRecord& for_each_edge, std::uint64_t edge_count,
                          std::int64_t e, std::uint64_t memory, const Job& job, RawLoops& loops) {
  if (edge_count <= static_cast<std::uint64_t>(e)) return;  // a loop has more
  RowNumbers rows;
  rows.collect(edge_count, [&](auto&& add) {
    for_each_edge([&](const BoundaryEdge& edge) {
      add(edge.a.row);
      add(edge.b.row);
    });
  });
  if (rows.size() <= static_cast<std::uint64_t>(e)) return;

  // Sort the edges.
  Scratch scratch(job.workspace, memory / 3);
  const std::span<PointId> ids = scratch.array<PointId>(rows.size());
  SortedRuns<OrderedEdge> edges(job.workspace / "ordered-edges", memory / 6);
  for_each_edge([&](const BoundaryEdge& edge) {
    scratch.trim();
    const LocalIndex a = rows.number(edge.a.row), b = rows.number(edge.b.row);
    ids[a] = edge.a.id;
    ids[b] = edge.b.id;
    const auto [low, high] = std::minmax(edge.a.id, edge.b.id);
    edges.add({edge.weight, low, high, a, b});
  });

  // Span them. No loop needs the trees.
  SpanningGraph graph;
  {
    Scratch work(job.workspace, memory / 2);
    Spanning spanning(ids, e, work);
    edges.for_each([&](const OrderedEdge& edge) { spanning.add(edge.a, edge.b); });
    graph = keep_cycles(spanning.finish(), scratch);
  }

  // Search them for loops.
  Scratch search(job.workspace, memory / 3 * 2);
  std::vector<Vertex> loop;
  find_loops(graph, search, [&](std::span<const LocalIndex> found) {
    loop.clear();
    for (const LocalIndex v : found) loop.push_back({graph.ids[v], rows.row(v)});
    loops.add(loop);
  });
}

}  // namespace lacuna::paper
