// SPDX-License-Identifier: Apache-2.0
// A cloud on its way through the passes, for tests of single passes.
#pragma once

#include "engine/boundary/boundary_method.hpp"
#include "engine/boundary/paper/paper_boundary.hpp"
#include "engine/bucket/bucket_scan.hpp"
#include "engine/evaluate/evaluate_tiles.hpp"
#include "engine/survey/survey.hpp"
#include "engine/thin/level.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna {

// Surveyed, split and bucketed, in a workspace of its own.
struct TiledScan {
  TiledScan(const Cloud& cloud, const Config& config);
  TiledScan(PointSource& scan, const Config& config);
  TiledScan(const TiledScan&) = delete;
  TiledScan& operator=(const TiledScan&) = delete;

  // Evaluates every point, for these consumers.
  TileOutputs evaluate(const std::vector<TileConsumer>& consumers);
  Totals totals(const TileOutputs& outputs) const;
  // All steps of a method behind the evaluation.
  FoundLoops find_loops(BoundaryMethod& method, const TileOutputs& outputs) const;

  std::vector<TileIndex> all_tiles() const;
  std::map<PointId, Row> rows() const;  // of the stored points
  TileIndex tile_of(Row row) const { return store.tiling().tile_of_row(row); }
  LocalIndex local(Row row) const;  // in its tile

  ScratchFolder folder;
  Config config;
  NoProgress quiet;
  Job job;
  Level level;
  TileStore& store;
};

}  // namespace lacuna
