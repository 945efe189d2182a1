// SPDX-License-Identifier: Apache-2.0
#include "engine/pipeline.hpp"

#include "engine/boundary/candidates.hpp"
#include "engine/consumers.hpp"
#include "engine/evaluate/evaluate_tiles.hpp"
#include "engine/first_level.hpp"
#include "engine/halo/eps_balls.hpp"
#include "engine/halo/halo.hpp"
#include "engine/loops/measure_loops.hpp"
#include "engine/loops/nest_loops.hpp"
#include "engine/loops/rate_loops.hpp"
#include "engine/pipeline_steps.hpp"
#include "engine/results/collect.hpp"
#include "engine/results/loop_rows.hpp"
#include "engine/results/orientation_graph.hpp"
#include "engine/results/point_results.hpp"
#include "engine/results/represented.hpp"
#include "engine/results/scan_sample.hpp"
#include "engine/run/error.hpp"
#include "engine/summarise.hpp"
#include "engine/thin/thin.hpp"
#include "engine/track/level_loops.hpp"
#include "engine/track/track_loops.hpp"
#include "engine/workspace/sealed_level.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

struct LevelResult {
  TileOutputs outputs;
  Totals totals;
  FoundLoops boundary;
};

// Finds the loops of one level.
LevelResult find_loops(const Level& level, Consumers& consumers, const Workspace& workspace, Job& job) {
  // Halo, evaluate: each point's criteria from its exact neighbourhood (paper, 4.1 to 4.6).
  TileOutputs outputs = evaluate_level(level, consumers.all, workspace, job);
  Totals totals = read_totals(outputs, level.store.tiling(), level.extent);

  // Boundary edges, stitch, loops (paper, 5.1 and 5.2).
  Phase phase(job, "loops", 0);
  BoundaryMethod& method = *consumers.method;
  method.complete_edges(outputs);
  job.trim();
  method.stitch(outputs, totals);
  FoundLoops found = method.find_loops(outputs);
  if (job.config.loops.method == LoopMethod::kTangential) rate_loops(level.store, found.loops, job);
  return {std::move(outputs), std::move(totals), std::move(found)};
}

// Finds the loops of each level above, from fine to coarse.
void find_loops_above(const Level& first, Totals totals, std::vector<LevelLoops>& levels,
                      const Workspace& workspace, Job& job) {
  Phase phase(job, "levels", 2 * first.store.tiling().points());  // each has half of the points below
  std::optional<Level> below;
  while (std::optional<Level> level = level_above(below ? *below : first, totals, workspace, job)) {
    Consumers consumers(*level, job);
    LevelResult found = find_loops(*level, consumers, workspace, job);
    levels.push_back(level_loops(std::move(found.boundary.loops), level->edge, found.totals));
    totals = std::move(found.totals);
    phase.advance(level->store.tiling().points());
    below.emplace(*std::move(level));
  }
}

}  // namespace

std::optional<Level> thin_level(const Level& below, const Totals& totals, const TaskShare& share,
                                const Workspace& workspace, Job& job) {
  const double edge = edge_above(below, totals.distances);
  if (edge == 0) return std::nullopt;
  Level part = thin_above(below, share, edge, level_files(below.number + 1, workspace, job), job);
  if (share.tasks == 1 && part.store.tiling().points() < kFewestOfLevel) return std::nullopt;
  seal_part(part, share, made_from(below, job.config), workspace, job);
  return part;
}

std::optional<Level> level_above(const Level& below, const Totals& totals, const Workspace& workspace,
                                 Job& job) {
  const std::size_t number = below.number + 1;
  const std::string from = made_from(below, job.config);
  std::optional<Level> level = open_level(number, from, workspace, job);
  if (!level) {
    const std::size_t tasks = tasks_of(number, workspace.plan);
    if (tasks == 1) return thin_level(below, totals, {}, workspace, job);
    for (std::size_t task = 0; task < tasks; ++task) {
      if (!has_part(number, {task, tasks}, from, workspace, job))
        thin_level(below, totals, {task, tasks}, workspace, job);
    }
    level = open_level(number, from, workspace, job);
    if (!level) fail_replaced(workspace);
  }
  return level->store.tiling().points() >= kFewestOfLevel ? std::move(level) : std::nullopt;
}

TileOutputs evaluate_level(const Level& level, std::span<const TileConsumer> consumers,
                           const Workspace& workspace, Job& job, const TaskShare& share) {
  const Tiling& tiling = level.store.tiling();
  TileOutputs outputs(tiling, find_outputs(level, workspace, job.config), job);
  std::vector<TileIndex> tiles = outputs.missing();
  const TileRange range = tiling.tiles_in(share);
  std::erase_if(tiles, [&](TileIndex t) { return t < range.first || t >= range.last; });
  evaluate_tiles(level, tiles, exchange_halo(level.store, tiles, job), consumers, outputs, job);
  return outputs;
}

namespace {

std::unique_ptr<Detection> detect_once(PointSource& scan, const Config& config, const fs::path& scratch,
                                       Progress& progress) {
  Job job(config, scratch, progress);
  const Workspace workspace = open_workspace(scan, config);

  // Survey and bucket: find where the points are, and bring them into tiles on disk.
  Level first = first_level(scan, workspace, job);
  const TileStore& store = first.store;
  Summary summary = summarise(first, job);
  const double eps = eps_length(config.neighbourhood, first.extent);
  refuse_balls(store.tiling(), eps, job);  // the balls of thinner levels hold fewer points

  // Finds the loops of all levels.
  Consumers consumers(first, job);
  LevelResult found = find_loops(first, consumers, workspace, job);
  const TileOutputs& outputs = found.outputs;
  std::vector<LevelLoops> levels;
  levels.push_back(level_loops(std::move(found.boundary.loops), first.edge, found.totals));
  if (has_levels(config)) find_loops_above(first, found.totals, levels, workspace, job);
  add_findings(found.totals, found.boundary, levels, eps, summary);

  // Track: follows each hole through the levels.
  TrackedLoops tracked = track_loops(std::move(levels), job);
  MeasuredLoops loops =
      measure_loops(std::move(tracked.loops), tracked.tracks, found.totals.mean_edge_length(), job);

  // Nest: finds the islands of holes, and takes their areas from the holes'.
  nest_loops(loops, job);

  // Brings the results into the order of the input.
  std::vector<std::size_t> selected = select_loops(loops.measures, config.selection);
  LoopRows on_loops = find_loop_rows(loops.loops, selected, store, job);
  RowSet coherent = coherent_candidates(outputs, store.tiling(), job);
  RowSet boundary_candidates = consumers.method->boundary_candidates(outputs, coherent, on_loops.rows);
  Findings findings{.summary = std::move(summary),
                    .loops = std::move(loops),
                    .selected = std::move(selected),
                    .on_loops = std::move(on_loops),
                    .coherent = std::move(coherent),
                    .boundary_candidates = std::move(boundary_candidates)};
  if (config.results.points) findings.points.emplace(outputs, first.survey.points, store, job);
  if (consumers.sample)
    findings.sample.emplace(consumers.sample->draw(outputs, store.tiling().tiles.size(), job));
  if (config.normals.orient) findings.opposed_normals = opposed_normals(outputs, store, job);
  std::unique_ptr<Detection> detection = collect_results(std::move(findings), outputs, store, job);
  if (!first.represented) return detection;
  return spread_results(std::move(detection), *std::move(first.represented), job);
}

}  // namespace

std::unique_ptr<Detection> detect(PointSource& scan, const Config& given, const fs::path& scratch,
                                  Progress& progress) {
  check_config(given);
  const Config config = with_min_hole(given);
  const Config shared = with_planned_tiles(config);
  return without_damaged_files([&] { return detect_once(scan, shared, scratch, progress); });
}

}  // namespace lacuna
