// SPDX-License-Identifier: Apache-2.0
#include "engine/pipeline.hpp"

#include "engine/boundary/candidates.hpp"
#include "engine/consumers.hpp"
#include "engine/halo/eps_balls.hpp"
#include "engine/level_steps.hpp"
#include "engine/loops/measure_loops.hpp"
#include "engine/loops/nest_loops.hpp"
#include "engine/parts/kept_files.hpp"
#include "engine/parts/kept_run.hpp"
#include "engine/results/collect.hpp"
#include "engine/results/loop_rows.hpp"
#include "engine/results/orientation_graph.hpp"
#include "engine/results/represented.hpp"
#include "engine/results/scan_sample.hpp"
#include "engine/scan_steps.hpp"
#include "engine/summarise.hpp"
#include "engine/thin/thin.hpp"
#include "engine/track/level_loops.hpp"
#include "engine/track/track_loops.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

// Finds the loops of each level above the first one, from fine to coarse.
void find_loops_above(const Level& first, Totals totals, std::vector<LevelLoops>& levels,
                      const StepContext& given) {
  Phase phase(given.job.phases, "levels", first.store.tiling().points());  // each has half of those below
  const double far = totals.distances.start_of_far();
  std::optional<Level> below;
  while (std::optional<Level> level = level_above(
             below ? *below : first, [&] { return totals; }, given)) {
    Consumers consumers(*level, given.job);
    std::optional<TileOutputs> outputs;
    const auto evaluate = [&]() -> const TileOutputs& {
      return outputs.emplace(evaluate_level(*level, consumers.all, given));
    };
    FoundLevel found = loops_of_level(*level, *consumers.method, evaluate, given);
    levels.push_back(level_loops(std::move(found.boundary.loops), level->edge, found.totals, far));
    totals = std::move(found.totals);
    phase.advance(level->store.tiling().points());
    below.emplace(*std::move(level));
  }
}

std::unique_ptr<Detection> detect_once(PointSource& scan, const Config& config, const fs::path& temporary,
                                       Progress& progress) {
  Job job(config, temporary, progress);
  auto& [settings, workers, spill, phases] = job;
  const Parts parts = open_parts(scan, config, progress, Opener::kRun);
  const StepContext given{scan, parts, job};

  // Survey and bucket: find where the points are, and bring them into tiles on disk.
  Level first = first_level(given);
  const TileStore& store = first.store;
  Summary summary = summarise(first, workers);
  const double eps = eps_length(config.neighbourhood, first.extent);
  refuse_balls(store.tiling(), eps, workers);  // the balls of thinner levels hold fewer points

  // Halo, evaluate: each point's criteria from its exact neighbourhood (paper, 4.1 to 4.6).
  Consumers consumers(first, job);
  const TileOutputs outputs = evaluate_level(first, consumers.all, given);

  // Boundary edges, stitch, loops (paper, 5.1 and 5.2), of all levels.
  FoundLevel found = loops_of_level(
      first, *consumers.method, [&]() -> const TileOutputs& { return outputs; }, given);
  std::vector<LevelLoops> levels;
  levels.push_back(level_loops(std::move(found.boundary.loops), first.edge, found.totals,
                               found.totals.distances.start_of_far()));
  if (has_levels(config)) find_loops_above(first, found.totals, levels, given);
  add_findings(found.totals, found.boundary, levels, eps, summary);

  // Track: follows each hole through the levels.
  TrackedLoops tracked = track_loops(std::move(levels), job);
  MeasuredLoops loops = measure_loops(std::move(tracked.loops), tracked.tracks,
                                      found.totals.mean_edge_length(), spill, workers, phases);

  // Nest: finds the islands of holes, and takes their areas from the holes'.
  nest_loops(loops, spill, workers, phases);

  // Brings the results into the order of the input.
  std::vector<std::size_t> selected = select_loops(loops.measures, config.selection);
  summary.hole_area = measure_hole_area(loops, selected, spill, workers);
  LoopRows on_loops = find_loop_rows(loops.loops, selected, store, spill, workers.arena);
  RowSet coherent = coherent_candidates(outputs, store.tiling(), workers.arena, phases);
  RowSet boundary_candidates = consumers.method->boundary_candidates(outputs, coherent, on_loops.rows);
  Findings findings{.summary = std::move(summary),
                    .loops = std::move(loops),
                    .selected = std::move(selected),
                    .on_loops = std::move(on_loops),
                    .coherent = std::move(coherent),
                    .boundary_candidates = std::move(boundary_candidates)};
  if (config.results.points) findings.points.emplace(outputs, first.survey.points, store, spill, workers);
  if (consumers.sample)
    findings.sample.emplace(
        consumers.sample->draw(outputs, store.tiling().tiles.size(), spill, workers, phases));
  if (config.normals.orient)
    findings.opposed_normals = opposed_normals(outputs, store, spill, workers, phases);
  std::unique_ptr<Detection> detection =
      collect_results(std::move(findings), outputs, store, spill, workers, phases);
  if (!first.represented) return detection;
  return spread_results(std::move(detection), *std::move(first.represented), spill);
}

}  // namespace

std::unique_ptr<Detection> detect(PointSource& scan, const Config& given, const fs::path& temporary,
                                  Progress& progress) {
  check_config(given);
  const Config config = with_min_hole(given);
  const Config shared = with_planned_tiles(config);
  return without_damaged_files([&] { return detect_once(scan, shared, temporary, progress); });
}

}  // namespace lacuna
