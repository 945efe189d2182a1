// SPDX-License-Identifier: Apache-2.0
#include "engine/unit.hpp"

#include "engine/consumers.hpp"
#include "engine/first_level.hpp"
#include "engine/pipeline_steps.hpp"
#include "engine/run/error.hpp"
#include "engine/thin/thin.hpp"
#include "engine/workspace/sealed_level.hpp"
#include "engine/workspace/workspace.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

using Kind = Step::Kind;

// By kind. The steps of levels have a number behind the name.
constexpr std::array<std::string_view, 5> kNames = {"survey", "tiles", "bucket", "level-", "evaluate-"};

bool is_of_level(Kind kind) {
  return kind == Kind::kLevel || kind == Kind::kEvaluate;
}

std::string_view name_of(Kind kind) {
  return kNames.at(static_cast<std::size_t>(kind));
}

constexpr std::uint64_t kTilesOfTask = 8;  // so that tasks take about equally long

// With fewer points, to start a task takes longer than what it does.
constexpr std::uint64_t kFewestOfTask = 100'000;

Totals totals_of(const Level& level, const Workspace& workspace, Job& job) {
  const Consumers consumers(level, job);
  const TileOutputs outputs = evaluate_level(level, consumers.all, workspace, job);
  return read_totals(outputs, level.store.tiling(), level.extent);
}

std::optional<Level> make_level(std::size_t number, PointSource& scan, const Workspace& workspace, Job& job) {
  if (number == 0) return first_level(scan, workspace, job);
  if (std::optional<Level> kept = find_level(number, workspace, job)) return kept;
  const std::optional<Level> below = make_level(number - 1, scan, workspace, job);
  if (!below) return std::nullopt;
  return level_above(*below, totals_of(*below, workspace, job), workspace, job);
}

// Makes a part of a level above the first one, unless it is there. Returns false where there is no such
// level.
bool thin_share(std::size_t number, const TaskShare& share, PointSource& scan, const Workspace& workspace,
                Job& job) {
  if (find_level(number, workspace, job)) return true;
  const std::optional<Level> below = make_level(number - 1, scan, workspace, job);
  if (!below) return false;
  if (has_part(number, share, made_from(*below, job.config), workspace, job)) return true;
  return thin_level(*below, totals_of(*below, workspace, job), share, workspace, job).has_value();
}

bool make_points(const Step& step, std::size_t task, PointSource& scan, const Workspace& workspace,
                 Job& job) {
  const TaskShare share{task, tasks_of(step.level, workspace.plan)};
  if (task >= share.tasks) return true;
  if (step.level > 0) return thin_share(step.level, share, scan, workspace, job);
  if (workspace.plan.reads) {
    store_share(scan, share, workspace, job);
  } else {
    first_level(scan, workspace, job);
  }
  return true;
}

bool evaluate_share(const Step& step, std::size_t task, PointSource& scan, const Workspace& workspace,
                    Job& job) {
  const std::optional<Level> level = make_level(step.level, scan, workspace, job);
  if (!level) return false;
  const Consumers consumers(*level, job);
  evaluate_level(*level, consumers.all, workspace, job, {task, step.tasks});
  return true;
}

bool work_once(PointSource& scan, const Config& config, const Step& step, std::size_t task,
               const fs::path& scratch, Progress& progress) {
  Job job(config, scratch, progress);
  const Workspace workspace = open_workspace(scan, config, true);
  if (step.kind == Kind::kEvaluate) return evaluate_share(step, task, scan, workspace, job);
  if (step.kind == Kind::kLevel) return make_points(step, task, scan, workspace, job);
  if (!workspace.plan.reads) return false;
  if (find_level(0, workspace, job)) return true;
  const TaskShare share{task, workspace.plan.tasks};
  if (step.kind == Kind::kSurvey) survey_share(scan, share, workspace, job);
  if (step.kind == Kind::kTiles) plan_shared_tiles(scan, workspace, job);
  if (step.kind == Kind::kBucket) scatter_share(scan, share, workspace, job);
  return true;
}

}  // namespace

std::string Step::name() const {
  return std::string(name_of(kind)) + (is_of_level(kind) ? std::to_string(level) : "");
}

std::vector<Step> plan(PointSource& scan, const Config& given, std::size_t tasks, std::uint64_t points) {
  check_config(given);
  const Config config = with_min_hole(given);
  NoProgress silence;
  const Job job(config, config.run.workspace, silence);
  const Workspace workspace = open_workspace(scan, config, true);  // units of an earlier plan may be at work
  TaskPlan plan{.tasks = tasks,
                .tile_points = std::min(job.tile_points(points), points / tasks / kTilesOfTask + 1),
                .reads = can_share_reading(scan, config)};
  std::vector<Step> steps;
  if (plan.reads) {
    steps.push_back({.kind = Kind::kSurvey, .tasks = tasks, .points = points});
    steps.push_back({.kind = Kind::kTiles, .points = points});
    steps.push_back({.kind = Kind::kBucket, .tasks = tasks, .points = points});
  }
  const std::size_t levels = has_levels(config) ? kMostLevels : 1;
  for (std::size_t level = 0; level < levels; ++level, points /= 2) {
    if (level > 0 && points < tasks * kFewestOfTask) break;
    plan.levels = level + 1;
    steps.push_back({.level = level, .tasks = tasks_of(level, plan), .points = points});
    steps.push_back({.kind = Kind::kEvaluate, .level = level, .tasks = tasks, .points = points});
  }
  write_plan(workspace.folder, plan);
  return steps;
}

std::optional<Step> step_of_name(std::string_view name, const fs::path& workspace) {
  Step step;
  const auto is_kind = [&](std::string_view kind) { return name.starts_with(kind); };
  const auto kind = std::find_if(kNames.begin(), kNames.end(), is_kind);
  if (kind == kNames.end()) return std::nullopt;
  step.kind = static_cast<Kind>(kind - kNames.begin());
  name.remove_prefix(kind->size());
  if (is_of_level(step.kind)) {
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), step.level);
    if (error != std::errc() || step.level >= kMostLevels) return std::nullopt;
    name.remove_prefix(static_cast<std::size_t>(end - name.data()));
  }
  if (!name.empty()) return std::nullopt;
  const std::optional<TaskPlan> plan = read_plan(workspace);
  if (!plan) throw Error(workspace.string() + ": has no plan; allowed: a workspace of lacuna plan");
  step.tasks = step.kind == Kind::kTiles   ? 1
               : step.kind == Kind::kLevel ? tasks_of(step.level, *plan)
                                           : plan->tasks;
  return step;
}

bool work(PointSource& scan, const Config& given, const Step& step, std::size_t task,
          const std::filesystem::path& scratch, Progress& progress) {
  check_config(given);
  const Config config = with_planned_tiles(with_min_hole(given));
  return without_damaged_files([&] { return work_once(scan, config, step, task, scratch, progress); });
}

}  // namespace lacuna
