// SPDX-License-Identifier: Apache-2.0
// What the two methods have in common: each takes boundary edges from the evaluated tiles, stitches them
// across tiles, and finds loops in the components.
#pragma once

#include "engine/boundary/candidates.hpp"
#include "engine/evaluate/evaluate_tiles.hpp"
#include "engine/loops/loop_points.hpp"
#include "engine/loops/raw_loops.hpp"
#include "engine/run/job.hpp"
#include "engine/store/row_set.hpp"

#include <cstdint>

namespace lacuna {

struct FoundLoops {
  RawLoops loops;                 // sorted
  std::uint64_t edges = 0;        // of the boundary graph
  std::uint64_t components = 0;   // of the boundary graph, with an edge
  std::int64_t minimum_loop = 0;  // e, in effect; 0: the method has none
};

class BoundaryMethod : public TileConsumer {
 public:
  explicit BoundaryMethod(LoopPointLists points) : loop_points_(std::move(points)) {}

  // All tiles are taken. Consumes the edges: to be called once.
  virtual FoundLoops find_loops(const Totals& totals, Job& job) = 0;
  // The candidates that belong to the boundary, in addition to the points on loops. `on_loop`: these.
  virtual RowSet boundary_candidates(const Candidates& candidates, const RowSet& coherent,
                                     const RowSet& on_loop, Job& job) const = 0;

  // All points that the loops may pass through.
  const LoopPointLists& loop_points() const { return loop_points_; }

 protected:
  LoopPointLists loop_points_;
};

}  // namespace lacuna
