// A cloud on its way through the passes, for tests of single passes.
#pragma once

#include "engine/passes/bucket.hpp"
#include "engine/passes/evaluate.hpp"
#include "engine/passes/trace.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/scratch_folder.hpp"

#include <cstdint>
#include <map>
#include <vector>

namespace lacuna {

// Surveyed, split and bucketed, in a workspace of its own.
struct TiledScan {
  TiledScan(const Cloud& cloud, const Config& config);
  TiledScan(PointSource& scan, const Config& config);
  TiledScan(const TiledScan&) = delete;
  TiledScan& operator=(const TiledScan&) = delete;

  EvaluatedScan evaluate();  // with its links
  // The loops, where the global stage has so many bytes; 0: as many as the job gives it.
  TracedLoops trace(EvaluatedScan& evaluated, std::uint64_t global_memory = 0);

  std::map<PointId, Row> rows() const;  // of the stored points
  TileIndex tile_of(Row row) const { return store.tiling().tile_of_row(row); }
  LocalIndex local(Row row) const;  // in its tile

  test::ScratchFolder folder;
  Config config;
  NoProgress quiet;
  Job job;
  SurveyedScan survey;  // without its cells
  TileStore store;
};

}  // namespace lacuna
