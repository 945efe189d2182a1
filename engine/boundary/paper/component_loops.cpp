// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/component_loops.hpp"

#include "engine/boundary/paper/cycles.hpp"
#include "engine/boundary/paper/span_whole.hpp"
#include "engine/store/row_numbers.hpp"

#include <functional>

namespace lacuna::paper {

// Vertices are numbered by row: near in space, near in memory.
void find_component_loops(const Stitch<BoundaryEdge>::ForEachRecord& for_each_edge, std::uint64_t edge_count,
                          std::int64_t e, std::uint64_t memory, const Spill& spill, RawLoops& loops) {
  if (edge_count <= static_cast<std::uint64_t>(e)) return;  // a loop has more
  RowNumbers rows;
  rows.collect(edge_count, [&](auto&& add) {
    for_each_edge([&](const BoundaryEdge& edge) {
      add(edge.a.row);
      add(edge.b.row);
    });
  });
  if (rows.size() <= static_cast<std::uint64_t>(e)) return;
  Scratch scratch(spill.folder, memory / 3);
  const std::span<PointId> ids = scratch.array<PointId>(rows.size());
  for_each_edge([&](const BoundaryEdge& edge) {
    scratch.trim();
    ids[rows.number(edge.a.row)] = edge.a.id;
    ids[rows.number(edge.b.row)] = edge.b.id;
  });
  const auto for_each_passed = [&](const std::function<void(const PassedEdge&)>& visit) {
    for_each_edge([&](const BoundaryEdge& edge) {
      visit({rows.number(edge.a.row), rows.number(edge.b.row), edge.weight, edge.is_taken != 0});
    });
  };
  SpanningGraph cycles;
  {
    Scratch work(spill.folder, memory / 2);
    cycles = keep_cycles(span_whole(ids, for_each_passed, e, memory / 6, work), scratch);
  }
  Scratch search(spill.folder, memory / 3 * 2);
  find_loops_of(
      cycles, [&](LocalIndex v) { return rows.row(v); }, search, loops);
}

}  // namespace lacuna::paper
