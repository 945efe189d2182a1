// SPDX-License-Identifier: Apache-2.0
// The table of the steps of a run whose parts are kept, and their tasks, which several processes may share on
// one machine or many.
//
// A task makes its share of a step, from the parts of the steps before. It repeats no work that a part proves
// to be done. So a task may be started again, also while its first copy still runs. What it needs and does
// not find, it makes. A run that goes on in the folder makes all that is still missing.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/points.hpp"
#include "engine/run/progress.hpp"
#include "engine/scan_steps.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

// A row of the table.
struct StepRule {
  std::string_view name;
  bool is_of_level = false;  // there is one for each level
  bool reads_scan = false;   // only where tasks share the reading of the scan
  bool is_shared = true;     // among tasks
  // Makes a task's share. Returns false where the run has no such level.
  bool (*make)(const StepContext& given, std::size_t level, const TaskShare& share) = nullptr;
};

// A step of a planned run.
struct Step {
  const StepRule* rule = nullptr;
  std::size_t level = 0;
  std::size_t tasks = 1;     // which may be done at the same time
  std::uint64_t points = 0;  // that pass through it, about

  std::string name() const;  // "survey", "level-0", "evaluate-0"
};

inline constexpr std::size_t kMostTasks = 100'000;

// Opens the kept folder that the config names for tasks of this run. Returns the steps, in order. Each step
// needs the step before. Levels of few points are left to the process that ends the run. `points`: of the
// scan, about.
std::vector<Step> plan(PointSource& scan, const Config& config, std::size_t tasks, std::uint64_t points);

// Returns nothing where no step has this name, whatever the scan. Throws `Error` where no plan was made
// there.
std::optional<Step> step_of_name(std::string_view name, const std::filesystem::path& folder);

// Does one task, from 0 to `step.tasks` - 1. `config`: names the kept folder. `scan`: the input of the run.
// Returns false where there is nothing to do. Throws `Error`.
bool do_task(PointSource& scan, const Config& config, const Step& step, std::size_t task,
             const std::filesystem::path& temporary, Progress& progress);

}  // namespace lacuna
