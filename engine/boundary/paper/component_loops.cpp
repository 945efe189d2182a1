#include "engine/boundary/paper/component_loops.hpp"

#include "engine/boundary/paper/order_edges.hpp"
#include "engine/store/row_numbers.hpp"
#include "engine/store/sorted_runs.hpp"

#include <functional>

namespace lacuna::paper {

// Vertices are numbered by row: near in space, near in memory.
void find_component_loops(std::span<const BoundaryEdge> edges, std::int64_t e, const Job& job,
                          RawLoops& loops) {
  if (edges.size() <= static_cast<std::uint64_t>(e)) return;  // a loop has more
  RowNumbers rows;
  rows.collect(edges.size(), [&](auto&& add) {
    for (const BoundaryEdge& edge : edges) {
      add(edge.a.row);
      add(edge.b.row);
    }
  });
  if (rows.size() <= static_cast<std::uint64_t>(e)) return;
  std::vector<PointId> ids(rows.size());
  std::vector<WeightedEdge> sorted;
  sorted.reserve(edges.size());
  for (const BoundaryEdge& edge : edges) {
    const LocalIndex a = rows.number(edge.a.row), b = rows.number(edge.b.row);
    ids[a] = edge.a.id;
    ids[b] = edge.b.id;
    sorted.push_back({a, b, edge.weight});
  }
  order_edges(sorted, ids);
  Scratch scratch(job.workspace, job.memory.limit);
  Spanning spanning(ids, e, scratch);
  for (const WeightedEdge& edge : sorted) spanning.add({edge.a, edge.b});
  std::vector<WeightedEdge>().swap(sorted);
  find_loops_of(
      spanning.finish(), [&](LocalIndex v) { return rows.row(v); }, scratch, loops);
}

void find_large_component_loops(const Stitch<BoundaryEdge>::ForEachRecord& for_each_edge,
                                std::uint64_t edge_count, std::int64_t e, const Job& job, RawLoops& loops) {
  RowNumbers rows;
  rows.collect(edge_count, [&](auto&& add) {
    for_each_edge([&](const BoundaryEdge& edge) {
      add(edge.a.row);
      add(edge.b.row);
    });
  });
  SortedRuns<BoundaryEdge> sorted(job.file("large-edges"), job.memory.global / 8);
  Scratch scratch(job.workspace, job.memory.global * 5 / 8);
  const std::span<PointId> ids = scratch.array<PointId>(rows.size());
  for_each_edge([&](const BoundaryEdge& edge) {
    scratch.trim();
    sorted.add(edge);
    ids[rows.number(edge.a.row)] = edge.a.id;
    ids[rows.number(edge.b.row)] = edge.b.id;
  });
  Spanning spanning(ids, e, scratch);
  sorted.for_each([&](const BoundaryEdge& edge) {
    spanning.add({rows.number(edge.a.row), rows.number(edge.b.row)});
  });
  find_loops_of(
      spanning.finish(), [&](LocalIndex v) { return rows.row(v); }, scratch, loops);
}

}  // namespace lacuna::paper
