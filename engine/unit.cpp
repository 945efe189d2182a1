// SPDX-License-Identifier: Apache-2.0
#include "engine/unit.hpp"

#include "engine/consumers.hpp"
#include "engine/pipeline_steps.hpp"
#include "engine/run/error.hpp"
#include "engine/thin/thin.hpp"
#include "engine/workspace/sealed_level.hpp"
#include "engine/workspace/workspace.hpp"

#include <algorithm>
#include <charconv>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kLevel = "level-", kEvaluate = "evaluate-";

constexpr std::uint64_t kTilesOfTask = 8;  // so that tasks take about equally long

// With fewer points, to start a task takes longer than what it does.
constexpr std::uint64_t kFewestOfTask = 100'000;

Totals totals_of(const Level& level, const Workspace& workspace, Job& job) {
  const Consumers consumers(level, job);
  const TileOutputs outputs = evaluate_level(level, consumers.all, workspace, job);
  return read_totals(outputs, level.store.tiling(), level.extent);
}

std::optional<Level> make_level(std::size_t number, PointSource& scan, const Workspace& workspace, Job& job) {
  if (std::optional<Level> kept = find_level(number, workspace, job)) return kept;
  if (number == 0) return first_level(scan, workspace, job);
  const std::optional<Level> below = make_level(number - 1, scan, workspace, job);
  if (!below) return std::nullopt;
  return level_above(*below, totals_of(*below, workspace, job), workspace, job);
}

// Makes a part of a level above the first one, unless it is there. Returns false where there is no such
// level.
bool make_part(const Step& step, std::size_t task, PointSource& scan, const Workspace& workspace, Job& job) {
  if (find_level(step.level, workspace, job)) return true;
  const std::optional<Level> below = make_level(step.level - 1, scan, workspace, job);
  if (!below) return false;
  const TaskShare share{task, tasks_of(step.level, workspace.plan)};
  if (task >= share.tasks || has_part(step.level, share, made_from(*below, job.config), workspace, job))
    return true;
  return thin_level(*below, totals_of(*below, workspace, job), share, workspace, job).has_value();
}

bool work_once(PointSource& scan, const Config& config, const Step& step, std::size_t task,
               const fs::path& scratch, Progress& progress) {
  Job job(config, scratch, progress);
  const Workspace workspace = open_workspace(scan, config, true);
  if (!step.evaluates && step.level > 0) return make_part(step, task, scan, workspace, job);
  const std::optional<Level> level = make_level(step.level, scan, workspace, job);
  if (!level) return false;
  if (!step.evaluates) return true;
  const Consumers consumers(*level, job);
  evaluate_level(*level, consumers.all, workspace, job, {task, step.tasks});
  return true;
}

}  // namespace

std::string Step::name() const {
  return std::string(evaluates ? kEvaluate : kLevel) + std::to_string(level);
}

std::vector<Step> plan(PointSource& scan, const Config& given, std::size_t tasks, std::uint64_t points) {
  check_config(given);
  Config config = with_min_hole(given);
  NoProgress silence;
  Job job(config, config.run.workspace, silence);
  if (config.run.tile_points == 0)
    config.run.tile_points =
        static_cast<std::int64_t>(std::min(job.tile_points(points), points / tasks / kTilesOfTask + 1));
  const Workspace workspace = open_workspace(scan, config, true);  // units of an earlier plan may be at work
  std::vector<Step> steps;
  const std::size_t levels = has_levels(config) ? kMostLevels : 1;
  for (std::size_t level = 0; level < levels; ++level, points /= 2) {
    if (level > 0 && points < tasks * kFewestOfTask) break;
    steps.push_back({.level = level, .tasks = level == 0 ? 1 : tasks, .points = points});
    steps.push_back({.level = level, .evaluates = true, .tasks = tasks, .points = points});
  }
  write_plan(workspace.folder, {.tasks = tasks, .levels = steps.back().level + 1});
  return steps;
}

std::optional<Step> step_of_name(std::string_view name, const fs::path& workspace) {
  Step step{.evaluates = name.starts_with(kEvaluate)};
  if (!step.evaluates && !name.starts_with(kLevel)) return std::nullopt;
  name.remove_prefix((step.evaluates ? kEvaluate : kLevel).size());
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), step.level);
  if (error != std::errc() || end != name.data() + name.size() || step.level >= kMostLevels)
    return std::nullopt;
  const std::optional<TaskPlan> plan = read_plan(workspace);
  if (!plan) throw Error(workspace.string() + ": has no plan; allowed: a workspace of lacuna plan");
  step.tasks = step.evaluates ? plan->tasks : step.level == 0 ? 1 : tasks_of(step.level, *plan);
  return step;
}

bool work(PointSource& scan, const Config& given, const Step& step, std::size_t task,
          const std::filesystem::path& scratch, Progress& progress) {
  check_config(given);
  const Config config = with_min_hole(given);
  return without_damaged_files([&] { return work_once(scan, config, step, task, scratch, progress); });
}

}  // namespace lacuna
