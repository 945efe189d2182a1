// SPDX-License-Identifier: Apache-2.0
// The results in the order of the input, ready to be written. In a thinned scan, each point has the results of
// its representative.
#pragma once

#include "engine/boundary/candidates.hpp"
#include "engine/loops/measure_loops.hpp"
#include "engine/model/detection.hpp"
#include "engine/results/loop_rows.hpp"
#include "engine/results/point_results.hpp"
#include "engine/run/memory.hpp"
#include "engine/run/parallel.hpp"
#include "engine/run/phase.hpp"
#include "engine/store/rows.hpp"
#include "engine/store/tile_store.hpp"
#include "engine/thin/choose_points.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace lacuna {

// The results of the stages.
struct Findings {
  Summary summary;
  MeasuredLoops loops;
  std::vector<std::size_t> selected;  // those that are reported
  LoopRows on_loops;
  RowSet coherent;                             // candidates that are (paper, 5.1)
  RowSet boundary_candidates;                  // candidates that belong to the boundary
  std::optional<PointResults> points;          // only with results.points
  std::optional<Column<SampledPoint>> sample;  // only with results.sample_points
  std::optional<RowSet> opposed_normals;       // rows whose normal is to be turned round
};

// Collects the results, and fills in the counts of boundary points.
std::unique_ptr<Detection> collect_results(Findings findings, const TileOutputs& outputs,
                                           const TileStore& store, const Spill& spill, const Workers& workers,
                                           Phases& phases);

// The detection on the representatives, with result blocks of all points of the input. Everything else is of
// representatives alone. Cost: one sort of all points on disk when the blocks are read. With results.points
// only.
std::unique_ptr<Detection> spread_results(std::unique_ptr<Detection> detection,
                                          AppendLists<Represented> represented, const Spill& spill);

}  // namespace lacuna
