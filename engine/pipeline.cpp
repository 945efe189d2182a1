// SPDX-License-Identifier: Apache-2.0
#include "engine/pipeline.hpp"

#include "engine/consumers.hpp"
#include "engine/halo/eps_balls.hpp"
#include "engine/levels/evaluate_level.hpp"
#include "engine/levels/level.hpp"
#include "engine/loops/measure_loops.hpp"
#include "engine/results/collect.hpp"
#include "engine/results/loop_rows.hpp"
#include "engine/results/represented.hpp"
#include "engine/summarise.hpp"
#include "engine/track/level_loops.hpp"
#include "engine/track/track_loops.hpp"
#include "engine/workspace/workspace.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

struct FoundLevel {
  Totals totals;
  FoundLoops found;
  LevelLoops loops;
};

// Finds the loops of one level. Halo and evaluate: each point's criteria from its exact neighbourhood
// (paper, 4.1 to 4.6). Then boundary edges, stitched across tiles to components, and their loops. Each
// consumer keeps what it needs of an evaluated tile.
FoundLevel find_loops(const Level& level, Consumers& consumers, Job& job) {
  Totals totals = evaluate_level(level, consumers.all, job, [&](TileIndex tile, const TileOutput& output) {
    for (TileConsumer* const consumer : consumers.all) consumer->absorb(tile, output);
  });
  FoundLoops found = consumers.boundary->find_loops(totals, job);
  LevelLoops loops = level_loops(level, totals, found, *consumers.boundary, job);
  return {std::move(totals), std::move(found), std::move(loops)};
}

// Finds the loops of each level above, from fine to coarse.
void find_loops_above(const Level& first, Totals totals, std::vector<LevelLoops>& levels, Job& job) {
  Phase phase(job, "levels", points_above(first));
  std::optional<Level> below;
  while (std::optional<Level> level = level_above(below ? *below : first, totals, job)) {
    Consumers consumers(*level, job);
    FoundLevel found = find_loops(*level, consumers, job);
    levels.push_back(std::move(found.loops));
    totals = std::move(found.totals);
    phase.advance(level->store.tiling().points());
    below.emplace(*std::move(level));
  }
}

}  // namespace

std::unique_ptr<Detection> detect(PointSource& scan, const Config& given,
                                  const std::filesystem::path& scratch, Progress& progress) {
  check_config(given);
  const Config config = with_min_hole(given);
  Job job(config, scratch, progress);
  open_workspace(scan, job);

  // Survey and bucket: where the points are, and the points in tiles on disk.
  Level first = first_level(scan, job);
  const TileStore& store = first.store;
  Summary summary = summarise(first, job);
  const double eps = eps_length(config.neighbourhood, first.extent);
  refuse_balls(store.tiling(), eps, job);  // those of thinner levels are smaller

  // The loops of the first level, and all else that is found of its points.
  Consumers consumers(first, job);
  FoundLevel found = find_loops(first, consumers, job);

  // The loops of the levels above, and each hole tracked through the levels.
  std::vector<LevelLoops> levels;
  levels.push_back(std::move(found.loops));
  if (has_levels(config)) find_loops_above(first, found.totals, levels, job);
  add_findings(found.totals, found.found, levels, eps, summary);
  MeasuredLoops loops =
      measure_loops(track_loops(std::move(levels), job), found.totals.mean_edge_length(), job);

  // Results, in the order of the input.
  std::vector<std::size_t> selected = select_loops(loops.measures, config.selection);
  LoopRows on_loops = find_loop_rows(loops.loops, selected, store, job);
  auto& [boundary, candidates, points, voxels, sampler, orientation, all] = consumers;
  RowSet coherent = candidates->coherent(job);
  RowSet boundary_candidates = boundary->boundary_candidates(*candidates, coherent, on_loops.rows, job);
  std::optional<ProbabilityGrid> probabilities;
  if (voxels) probabilities.emplace(voxels->finish(store, summary.strays.rest, job));
  std::optional<Column<StoredSample>> sample;
  if (sampler) sample.emplace(sampler->finish(job));
  std::optional<RowSet> opposed_normals;
  if (orientation) opposed_normals = orientation->opposed_normals(job);
  std::unique_ptr<Detection> detection =
      collect_results({std::move(summary), std::move(loops), std::move(selected), std::move(on_loops),
                       std::move(coherent), std::move(boundary_candidates), std::move(points),
                       std::move(probabilities), std::move(sample), std::move(opposed_normals)},
                      *candidates, store, job);
  if (!first.represented) return detection;
  return spread_results(std::move(detection), *std::move(first.represented), job);
}

}  // namespace lacuna
