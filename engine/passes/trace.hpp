// The global stage: the graph of eligible edges stitched across tiles, its components spanned, their loops.
#pragma once

#include "engine/passes/evaluate.hpp"
#include "engine/passes/raw_loops.hpp"

#include <cstdint>

namespace lacuna {

struct TracedLoops {
  RawLoops loops;  // sorted
  std::uint64_t eligible_edges = 0;
  std::uint64_t components = 0;  // of the graph of eligible edges, with an edge
};

// Each tile settles what it can: most edges, and the loops that lead to no other tile. What the tiles pass on
// is gathered by component, in batches that fit in memory, spanned again and searched. A component larger
// than that is sorted on disk and spanned in mapped arrays. Consumes edges and crossings.
TracedLoops trace_loops(EvaluatedScan& scan, const TileStore& store, std::int64_t e, Job& job);

}  // namespace lacuna
