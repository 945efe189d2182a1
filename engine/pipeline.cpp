// SPDX-License-Identifier: Apache-2.0
#include "engine/pipeline.hpp"

#include "engine/boundary/candidates.hpp"
#include "engine/consumers.hpp"
#include "engine/halo/halo.hpp"
#include "engine/level_steps.hpp"
#include "engine/loops/measure_loops.hpp"
#include "engine/loops/nest_loops.hpp"
#include "engine/parts/kept_run.hpp"
#include "engine/results/collect.hpp"
#include "engine/results/loop_rows.hpp"
#include "engine/results/orientation.hpp"
#include "engine/results/scan_sample.hpp"
#include "engine/scan_steps.hpp"
#include "engine/summarise.hpp"
#include "engine/thin/thin.hpp"
#include "engine/track/track_loops.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

// Finds the loops of each level above the first one, from fine to coarse. `far`: as in `level_loops`.
void find_loops_above(const Level& first, double far, std::vector<LevelLoops>& levels,
                      const StepContext& context) {
  Phase phase(context.job.phases, "levels", first.store.tiling().points());  // each has half of those below
  std::optional<Level> below;
  while (std::optional<Level> level = level_above(below ? *below : first, context)) {
    Consumers consumers(*level, context.job);
    std::optional<TileOutputs> outputs;
    const auto evaluate = [&]() -> const TileOutputs& {
      return outputs.emplace(evaluate_level(*level, consumers.all, context));
    };
    FoundLevel found = loops_of_level(*level, *consumers.method, evaluate, context);
    levels.push_back(level_loops(std::move(found.boundary.loops), level->edge, found.totals, far));
    level->distances = std::move(found.totals.distances);
    phase.advance(level->store.tiling().points());
    below.emplace(*std::move(level));
  }
}

// Brings the results into the order of the input.
std::unique_ptr<Detection> collect(MeasuredLoops loops, Summary summary, Consumers& consumers,
                                   const TileOutputs& outputs, Level& first, Job& job) {
  auto& [config, workers, spill, phases] = job;
  const TileStore& store = first.store;
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

std::unique_ptr<Detection> detect_once(PointSource& scan, const Config& config, const fs::path& temporary,
                                       Progress& progress) {
  Job job(config, temporary, progress);
  const Parts parts = open_parts(scan, config, progress, Opener::kRun);
  const StepContext context{scan, parts, job};

  // Survey and bucket: find where the points are, and bring them into tiles on disk.
  Level first = first_level(context);
  Summary summary = summarise(first, job.workers);
  const double eps = eps_length(config.neighbourhood, first.extent);
  refuse_balls(first.store.tiling(), eps, job.workers);  // the balls of thinner levels hold fewer points

  // Halo, evaluate: each point's criteria from its exact neighbourhood (paper, 4.1 to 4.6).
  Consumers consumers(first, job);
  const TileOutputs outputs = evaluate_level(first, consumers.all, context);

  // Boundary edges, stitch, loops (paper, 5.1 and 5.2), of all levels.
  FoundLevel found = loops_of_level(
      first, *consumers.method, [&]() -> const TileOutputs& { return outputs; }, context);
  first.distances = found.totals.distances;
  const double far = first.distances->start_of_far();
  std::vector<LevelLoops> levels;
  levels.push_back(level_loops(std::move(found.boundary.loops), first.edge, found.totals, far));
  if (has_levels(config)) find_loops_above(first, far, levels, context);
  add_findings(found.totals, found.boundary, levels, eps, summary);

  // Track: follows each hole through the levels.
  TrackedLoops tracked = track_loops(std::move(levels), job);

  // Measure and nest: the numbers of each loop, and the islands of holes.
  MeasuredLoops loops = measure_loops(std::move(tracked.loops), tracked.tracks,
                                      found.totals.mean_edge_length(), job.spill, job.workers, job.phases);
  nest_loops(loops, job.spill, job.workers, job.phases);

  return collect(std::move(loops), std::move(summary), consumers, outputs, first, job);
}

}  // namespace

std::unique_ptr<Detection> detect(PointSource& scan, const Config& given, const fs::path& temporary,
                                  Progress& progress) {
  const Config config = with_planned_tiles(effective(given));
  return without_damaged_files([&] { return detect_once(scan, config, temporary, progress); });
}

}  // namespace lacuna
