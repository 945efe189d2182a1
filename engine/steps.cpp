// SPDX-License-Identifier: Apache-2.0
#include "engine/steps.hpp"

#include "engine/bucket/split.hpp"
#include "engine/level_steps.hpp"
#include "engine/parts/kept_run.hpp"
#include "engine/thin/thin.hpp"

#include <algorithm>
#include <charconv>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

bool make_survey(const StepContext& context, std::size_t, const TaskShare& share) {
  survey_of_task(context, share.task);
  return true;
}

bool make_tiles(const StepContext& context, std::size_t, const TaskShare&) {
  tiles_of_scan(context);
  return true;
}

bool make_bucket(const StepContext& context, std::size_t, const TaskShare& share) {
  points_of_task(context, tiles_of_scan(context), share.task);
  return true;
}

bool make_level(const StepContext& context, std::size_t number, const TaskShare& share) {
  if (number == 0) {
    share_of_first_level(context, share.task);
    return true;
  }
  const std::optional<Level> below = level_of_number(number - 1, context);
  return below && share_of_level_above(*below, context, share.task);
}

bool make_evaluation(const StepContext& context, std::size_t number, const TaskShare& share) {
  const std::optional<Level> level = level_of_number(number, context);
  if (!level) return false;
  const Consumers consumers(*level, context.job);
  evaluate_level(*level, consumers.all, context, share);
  return true;
}

// In the order of the run.
constexpr StepRule kSteps[] = {
    // Counts the points of a task's files in cells.
    {.name = kSurvey, .reads_scan = true, .make = make_survey},
    // Plans the tiles, from all counts.
    {.name = kTiles, .reads_scan = true, .is_shared = false, .make = make_tiles},
    // Brings the points of a task's files to their tiles.
    {.name = kBucket, .reads_scan = true, .make = make_bucket},
    // Stores a task's tiles of a level.
    {.name = kLevel, .is_of_level = true, .make = make_level},
    // Evaluates a task's tiles of a level.
    {.name = kEvaluate, .is_of_level = true, .make = make_evaluation},
};

constexpr std::uint64_t kTilesOfTask = 8;  // so that tasks take about equally long

// With fewer points, to start a task takes longer than what it does.
constexpr std::uint64_t kFewestOfTask = 100'000;

std::size_t tasks_of(const StepRule& rule, std::size_t level, const TaskPlan& plan) {
  if (!rule.is_shared) return 1;
  return rule.name == kLevel ? plan.tasks_of_level(level) : plan.tasks;
}

bool do_task_once(PointSource& scan, const Config& config, const Step& step, std::size_t task,
                  const fs::path& temporary, Progress& progress) {
  Job job(config, temporary, progress);
  const Parts parts = open_parts(scan, config, progress, Opener::kUnit);
  const StepContext given{scan, parts, job};
  if (task >= tasks_of(*step.rule, step.level, parts.plan)) return true;
  if (step.rule->reads_scan && (!parts.plan.reads || is_first_level_kept(given))) return parts.plan.reads;
  return step.rule->make(given, step.level, {task, step.tasks});
}

}  // namespace

std::string Step::name() const {
  return rule->is_of_level ? step_of_level(rule->name, level) : std::string(rule->name);
}

std::vector<Step> plan(PointSource& scan, const Config& given, std::size_t tasks, std::uint64_t points) {
  const Config config = effective(given);
  NoProgress silence;
  const Workers workers = workers_of(config.run);
  const Parts parts = open_parts(scan, config, silence, Opener::kPlan);
  TaskPlan plan{
      .tasks = tasks,
      .tile_points = std::min(points_per_tile(points, config, workers), points / tasks / kTilesOfTask + 1),
      .reads = tasks > 1 && can_share_reading(parts.source, config)};
  std::vector<Step> steps;
  const auto add = [&](const StepRule& rule, std::size_t level) {
    steps.push_back({&rule, level, tasks_of(rule, level, plan), points >> level});
  };
  for (const StepRule& rule : kSteps)
    if (rule.reads_scan && plan.reads) add(rule, 0);
  const std::size_t levels = has_levels(config) ? kMostLevels : 1;
  for (; plan.levels < levels; ++plan.levels) {
    if (plan.levels > 0 && points >> plan.levels < tasks * kFewestOfTask) break;
  }
  for (std::size_t level = 0; level < plan.levels; ++level) {
    for (const StepRule& rule : kSteps)
      if (rule.is_of_level) add(rule, level);
  }
  write_plan(parts.folder, plan);
  return steps;
}

std::optional<Step> step_of_name(std::string_view name, const fs::path& folder) {
  const auto rule = std::ranges::find_if(kSteps, [&](const StepRule& r) { return name.starts_with(r.name); });
  if (rule == std::end(kSteps)) return std::nullopt;
  Step step{.rule = rule};
  name.remove_prefix(rule->name.size());
  if (rule->is_of_level) {
    if (!name.starts_with('-')) return std::nullopt;
    const auto [end, error] = std::from_chars(name.data() + 1, name.data() + name.size(), step.level);
    if (error != std::errc()) return std::nullopt;
    name.remove_prefix(static_cast<std::size_t>(end - name.data()));
  }
  if (!name.empty() || step.level >= kMostLevels) return std::nullopt;
  step.tasks = tasks_of(*rule, step.level, require_plan(folder));
  return step;
}

bool do_task(PointSource& scan, const Config& given, const Step& step, std::size_t task,
             const fs::path& temporary, Progress& progress) {
  const Config config = with_planned_tiles(effective(given));
  return without_damaged_files([&] { return do_task_once(scan, config, step, task, temporary, progress); });
}

}  // namespace lacuna
