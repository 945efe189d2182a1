// SPDX-License-Identifier: Apache-2.0
#include "engine/first_level.hpp"

#include "engine/bucket/bucket_scan.hpp"
#include "engine/evaluate/check_normals.hpp"
#include "engine/halo/eps_balls.hpp"
#include "engine/run/error.hpp"
#include "engine/store/kept_scan.hpp"
#include "engine/survey/survey_scan.hpp"
#include "engine/thin/thin.hpp"
#include "engine/workspace/sealed_level.hpp"
#include "engine/workspace/sealed_scan.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

Level level_of(const SurveyTotals& survey, std::uint64_t tile_points, TileStore store) {
  const double extent = extent_of(survey.bounds);
  return {.survey = survey,
          .extent = extent,
          .tile_points = tile_points,
          .store = std::move(store),
          .represented = {}};
}

// Brings all points of the scan into tiles on disk.
Level bucket_points(PointSource& given, StoreFiles files, Job& job) {
  std::optional<KeptScan> kept;
  if (given.reads_slowly()) kept.emplace(given, job.file("input"));
  PointSource& scan = kept ? *kept : given;
  SurveyedScan survey = survey_scan(scan, job);
  const TilePlan plan = plan_tiles(survey, job);
  const ScatteredPoints scattered = scatter_points(scan, plan, survey.precision(), plan.points, job);
  kept.reset();
  TileStore store = store_tiles(
      plan, {}, survey.bounds, {survey.precision(), given.has_normals()},
      [&](std::size_t place, const VisitPoints& visit) { scattered.for_each(place, visit); },
      std::move(files), job);
  return level_of(survey, plan.tile_points, std::move(store));
}

// Returns a part that was sealed a moment ago.
template <class Part>
Part found(std::optional<Part> part, const Workspace& workspace) {
  if (!part) fail_replaced(workspace);
  return *std::move(part);
}

IndexRange parts_of(const PointSource& scan, const TaskShare& share) {
  return share_of(scan.parts(), share);
}

SealedSurvey shared_survey(PointSource& scan, const TaskShare& share, const Workspace& workspace, Job& job) {
  if (std::optional<SealedSurvey> sealed = open_survey(share, workspace)) return *std::move(sealed);
  const SurveyedScan survey = survey_parts(scan, parts_of(scan, share), job);
  seal_survey(survey, scan.pass_counts(), share, workspace);
  return found(open_survey(share, workspace), workspace);
}

SealedPlan shared_plan(PointSource& scan, const Workspace& workspace, Job& job) {
  const std::size_t tasks = workspace.plan.tasks;
  if (const std::optional<std::string> seals = seals_of_surveys(tasks, workspace)) {
    if (std::optional<SealedPlan> kept = open_plan(*seals, workspace)) return *std::move(kept);
  }
  std::string seals;
  SealedPlan sealed;
  std::uint64_t first_id = 0;
  SurveyedScan survey = merge_surveys(
      tasks,
      [&](std::size_t task) {
        SealedSurvey part = shared_survey(scan, {task, tasks}, workspace, job);
        seals += part.seal;
        sealed.first_ids.push_back(first_id);
        first_id += part.survey.ids;
        sealed.pass_counts.resize(part.pass_counts.size());
        for (std::size_t i = 0; i < part.pass_counts.size(); ++i)
          sealed.pass_counts[i] += part.pass_counts[i];
        return std::move(part.survey);
      },
      scan.expected_points(), job);
  if (survey.points == survey.dropped) {  // the source says so in its own words
    scan.select(0, scan.parts().size(), PointId{0});
    survey_scan(scan, job);
  }
  sealed.plan = plan_tiles(survey, job);
  sealed.survey = survey;
  seal_plan(sealed, seals, workspace);
  return sealed;
}

PartReader shared_points(PointSource& scan, const SealedPlan& sealed, const TaskShare& share,
                         const Workspace& workspace, Job& job) {
  if (std::optional<PartReader> part = open_scattered(share, sealed.seal, workspace)) return *std::move(part);
  const IndexRange parts = parts_of(scan, share);
  scan.select(parts.first, parts.last, PointId{sealed.first_ids[share.task]});
  seal_scattered(scatter_points(scan, sealed.plan, sealed.survey.precision(), 0, job), share, sealed.seal,
                 workspace);
  return found(open_scattered(share, sealed.seal, workspace), workspace);
}

// Leaves out normals that are not wanted, or do not fit. Levels and outputs have no normals of theirs then.
void choose_normals(Level& level, const Job& job) {
  if (!level.store.has_normals()) return;
  const NormalsUse use = job.config.normals.use;
  if (use != NormalsUse::kEstimated) level.given_normals = check_normals(level.store, job.config, job.arena);
  if (use == NormalsUse::kEstimated || (use == NormalsUse::kFitting && !level.given_normals.fit()))
    level.store.leave_out_normals();
}

Level level_of_points(PointSource& scan, const Workspace& workspace, Job& job) {
  std::optional<Level> kept = open_level(0, workspace.made_from, workspace, job);
  if (!kept && workspace.plan.reads) {
    for (std::size_t task = 0; task < workspace.plan.tasks; ++task)
      store_share(scan, {task, workspace.plan.tasks}, workspace, job);
    scan.select(0, scan.parts().size(), PointId{0});
    kept = open_level(0, workspace.made_from, workspace, job);
  }
  if (kept) {
    scan.set_pass_counts(kept->input);
    if (workspace.plan.reads) remove_scan_parts(workspace);
    return *std::move(kept);
  }
  const bool is_thinned = first_edge(job.config.scale) > 0;
  Level all = bucket_points(scan, is_thinned ? temporary_files(job) : level_files(0, workspace, job), job);
  Level level = is_thinned ? thin_to_first(all, level_files(0, workspace, job), job) : std::move(all);
  level.input = scan.pass_counts();
  seal_part(level, {}, workspace.made_from, workspace, job);
  return level;
}

}  // namespace

bool can_share_reading(const PointSource& scan, const Config& config) {
  return !scan.parts().empty() && first_edge(config.scale) == 0;
}

void survey_share(PointSource& scan, const TaskShare& share, const Workspace& workspace, Job& job) {
  shared_survey(scan, share, workspace, job);
}

void plan_shared_tiles(PointSource& scan, const Workspace& workspace, Job& job) {
  shared_plan(scan, workspace, job);
}

void scatter_share(PointSource& scan, const TaskShare& share, const Workspace& workspace, Job& job) {
  shared_points(scan, shared_plan(scan, workspace, job), share, workspace, job);
}

void store_share(PointSource& scan, const TaskShare& share, const Workspace& workspace, Job& job) {
  if (has_part(0, share, workspace.made_from, workspace, job)) return;
  const SealedPlan sealed = shared_plan(scan, workspace, job);
  std::vector<PartReader> parts;
  for (std::size_t task = 0; task < share.tasks; ++task)
    parts.push_back(shared_points(scan, sealed, {task, share.tasks}, workspace, job));
  const PointForm form{sealed.survey.precision(), scan.has_normals()};
  const auto for_each = [&](std::size_t place, const VisitPoints& visit) {
    for (const PartReader& part : parts) visit_scattered(part, place, form, visit);
  };
  TileStore store = store_tiles(sealed.plan, share, sealed.survey.bounds, form, for_each,
                                level_files(0, workspace, job), job);
  Level level = level_of(sealed.survey, sealed.plan.tile_points, std::move(store));
  level.input = sealed.pass_counts;
  seal_part(level, share, workspace.made_from, workspace, job);
}

Level first_level(PointSource& scan, const Workspace& workspace, Job& job) {
  Level level = level_of_points(scan, workspace, job);
  choose_normals(level, job);
  return level;
}

}  // namespace lacuna
