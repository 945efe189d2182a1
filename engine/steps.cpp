// SPDX-License-Identifier: Apache-2.0
#include "engine/steps.hpp"

#include "engine/level_steps.hpp"
#include "engine/parts/kept_files.hpp"
#include "engine/parts/kept_run.hpp"
#include "engine/run/error.hpp"
#include "engine/thin/thin.hpp"

#include <algorithm>
#include <charconv>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

bool make_survey(const Run& run, std::size_t, const TaskShare& share) {
  survey_of_task(run, share.task);
  return true;
}

bool make_tiles(const Run& run, std::size_t, const TaskShare&) {
  tiles_of_scan(run);
  return true;
}

bool make_bucket(const Run& run, std::size_t, const TaskShare& share) {
  points_of_task(run, tiles_of_scan(run), share.task);
  return true;
}

bool make_level(const Run& run, std::size_t number, const TaskShare& share) {
  if (number == 0) {
    share_of_first_level(run, share.task);
    return true;
  }
  const std::optional<Level> below = level_of_number(number - 1, run);
  return below && share_of_level_above(
                      *below, [&] { return totals_of(*below, run); }, run, share.task);
}

bool make_evaluation(const Run& run, std::size_t number, const TaskShare& share) {
  const std::optional<Level> level = level_of_number(number, run);
  if (!level) return false;
  const Consumers consumers(*level, run.job);
  evaluate_level(*level, consumers.all, run, share);
  return true;
}

// In the order of the run.
constexpr StepForm kSteps[] = {
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

std::size_t tasks_of(const StepForm& form, std::size_t level, const TaskPlan& plan) {
  if (!form.is_shared) return 1;
  return form.name == kLevel ? plan.tasks_of_level(level) : plan.tasks;
}

bool work_once(PointSource& scan, const Config& config, const Step& step, std::size_t task,
               const fs::path& temporary, Progress& progress) {
  Job job(config, temporary, progress);
  const Parts parts = open_parts(scan, config, progress, Opener::kUnit);
  const Run run{scan, parts, job};
  if (task >= tasks_of(*step.form, step.level, parts.plan)) return true;
  if (step.form->reads_scan && (!parts.plan.reads || is_first_level_kept(run))) return parts.plan.reads;
  return step.form->make(run, step.level, {task, step.tasks});
}

}  // namespace

std::string Step::name() const {
  return form->is_of_level ? step_of_level(form->name, level) : std::string(form->name);
}

std::vector<Step> plan(PointSource& scan, const Config& given, std::size_t tasks, std::uint64_t points) {
  check_config(given);
  const Config config = with_min_hole(given);
  NoProgress silence;
  const Job job(config, config.run.workspace, silence);
  const Parts parts = open_parts(scan, config, silence, Opener::kPlan);
  TaskPlan plan{.tasks = tasks,
                .tile_points = std::min(job.tile_points(points), points / tasks / kTilesOfTask + 1),
                .reads = tasks > 1 && can_share_reading(parts.source, config)};
  std::vector<Step> steps;
  const auto add = [&](const StepForm& form, std::size_t level) {
    steps.push_back({&form, level, tasks_of(form, level, plan), points >> level});
  };
  for (const StepForm& form : kSteps)
    if (form.reads_scan && plan.reads) add(form, 0);
  const std::size_t levels = has_levels(config) ? kMostLevels : 1;
  for (; plan.levels < levels; ++plan.levels) {
    if (plan.levels > 0 && points >> plan.levels < tasks * kFewestOfTask) break;
  }
  for (std::size_t level = 0; level < plan.levels; ++level) {
    for (const StepForm& form : kSteps)
      if (form.is_of_level) add(form, level);
  }
  write_plan(parts.folder, plan);
  return steps;
}

std::optional<Step> step_of_name(std::string_view name, const fs::path& folder) {
  const auto form = std::ranges::find_if(kSteps, [&](const StepForm& f) { return name.starts_with(f.name); });
  if (form == std::end(kSteps)) return std::nullopt;
  Step step{.form = form};
  name.remove_prefix(form->name.size());
  if (form->is_of_level) {
    if (!name.starts_with('-')) return std::nullopt;
    const auto [end, error] = std::from_chars(name.data() + 1, name.data() + name.size(), step.level);
    if (error != std::errc()) return std::nullopt;
    name.remove_prefix(static_cast<std::size_t>(end - name.data()));
  }
  if (!name.empty() || step.level >= kMostLevels) return std::nullopt;
  step.tasks = tasks_of(*form, step.level, require_plan(folder));
  return step;
}

bool work(PointSource& scan, const Config& given, const Step& step, std::size_t task,
          const fs::path& temporary, Progress& progress) {
  check_config(given);
  const Config config = with_planned_tiles(with_min_hole(given));
  return without_damaged_files([&] { return work_once(scan, config, step, task, temporary, progress); });
}

}  // namespace lacuna
