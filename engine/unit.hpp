// SPDX-License-Identifier: Apache-2.0
// A run as units that several processes do, on one machine or many, in one workspace.
//
// A unit makes parts of the run: the points of a level, or the outputs of some of its tiles. It repeats no
// work that a part proves to be done. So a unit may be started again, also while its first copy still runs.
// If a unit needs something that it does not find, it makes it. A run that goes on in the workspace makes all
// that is still missing.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/points.hpp"
#include "engine/run/progress.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

struct Step {
  enum class Kind {
    kSurvey,    // counts the points of parts of the scan
    kTiles,     // plans the tiles, from all counts
    kBucket,    // brings the points of parts of the scan to their tiles
    kLevel,     // makes the points of a level
    kEvaluate,  // evaluates the tiles of a level
  };
  Kind kind = Kind::kLevel;
  std::size_t level = 0;
  std::size_t tasks = 1;     // units of the step, which may be done at the same time
  std::uint64_t points = 0;  // of the level, about

  std::string name() const;  // "survey", "level-0", "evaluate-0"
};

inline constexpr std::size_t kMostTasks = 100'000;

// Opens the workspace that the config names for units of this run. Returns the steps, in order. Each step
// needs the step before. Levels of few points are left to the process that ends the run. `points`: of the
// scan, about.
std::vector<Step> plan(PointSource& scan, const Config& config, std::size_t tasks, std::uint64_t points);

// Returns nothing where no step has this name, whatever the scan. Throws `Error` where no plan was made
// there.
std::optional<Step> step_of_name(std::string_view name, const std::filesystem::path& workspace);

// Does one unit, from 0 to `step.tasks` - 1. `config`: names the workspace. `scan`: the input of the run.
// Returns false where the run has no such level. Throws `Error`.
bool work(PointSource& scan, const Config& config, const Step& step, std::size_t task,
          const std::filesystem::path& scratch, Progress& progress);

}  // namespace lacuna
