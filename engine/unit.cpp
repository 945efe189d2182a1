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

std::size_t tasks_of_plan(const fs::path& workspace) {
  const std::string text = read_note(workspace, WorkspaceNote::kTasks).value_or("");
  std::size_t tasks = 0;
  std::from_chars(text.data(), text.data() + text.size(), tasks);
  if (tasks == 0) throw Error(workspace.string() + ": has no plan; allowed: a workspace of lacuna plan");
  return tasks;
}

std::optional<Level> make_level(std::size_t number, PointSource& scan, const Workspace& workspace, Job& job) {
  if (std::optional<Level> kept = find_level(number, workspace, job)) return kept;
  if (number == 0) return first_level(scan, workspace, job);
  const std::optional<Level> below = make_level(number - 1, scan, workspace, job);
  if (!below) return std::nullopt;
  const Consumers consumers(*below, true, job);
  const TileOutputs outputs = evaluate_level(*below, consumers.all, workspace, job);
  return level_above(*below, read_totals(outputs, below->store.tiling(), below->extent), workspace, job);
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
  write_note(workspace.folder, WorkspaceNote::kTasks, std::to_string(tasks));

  std::vector<Step> steps;
  const std::size_t levels = has_levels(config) ? kMostLevels : 1;
  for (std::size_t level = 0; level < levels; ++level, points /= 2) {
    if (level > 0 && points < tasks * kFewestOfTask) break;
    steps.push_back({.level = level, .points = points});
    steps.push_back({.level = level, .evaluates = true, .tasks = tasks, .points = points});
  }
  return steps;
}

std::optional<Step> step_of_name(std::string_view name, const fs::path& workspace) {
  Step step{.evaluates = name.starts_with(kEvaluate)};
  if (!step.evaluates && !name.starts_with(kLevel)) return std::nullopt;
  name.remove_prefix((step.evaluates ? kEvaluate : kLevel).size());
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), step.level);
  if (error != std::errc() || end != name.data() + name.size() || step.level >= kMostLevels)
    return std::nullopt;
  if (step.evaluates) step.tasks = tasks_of_plan(workspace);
  return step;
}

bool work(PointSource& scan, const Config& given, const Step& step, std::size_t task,
          const std::filesystem::path& scratch, Progress& progress) {
  check_config(given);
  const Config config = with_min_hole(given);
  Job job(config, scratch, progress);
  const Workspace workspace = open_workspace(scan, config, true);
  const std::optional<Level> level = make_level(step.level, scan, workspace, job);
  if (!level) return false;
  if (!step.evaluates) return true;
  const Consumers consumers(*level, true, job);
  evaluate_level(*level, consumers.all, workspace, job, TaskShare{task, step.tasks});
  return true;
}

}  // namespace lacuna
