// SPDX-License-Identifier: Apache-2.0
// The steps that bring the scan into its first level: survey, tiles, bucket, thin. One process does them, or
// several tasks that each read parts of the scan.
#pragma once

#include "engine/config/job.hpp"
#include "engine/model/points.hpp"
#include "engine/parts/parts.hpp"
#include "engine/scan_forms.hpp"
#include "engine/thin/level.hpp"

#include <cstddef>
#include <string>
#include <string_view>

namespace lacuna {

// What every step is given.
struct StepContext {
  PointSource& scan;
  const Parts& parts;
  Job& job;
};

// Names of steps, and of their parts. Steps of levels have the level's number behind the name.
inline constexpr std::string_view kSurvey = "survey", kTiles = "tiles", kBucket = "bucket", kLevel = "level";
std::string step_of_level(std::string_view name, std::size_t level);  // "level-0"

TaskSurvey survey_of_task(const StepContext& given, std::size_t task);

ScanTiles tiles_of_scan(const StepContext& given);

// The points that a task reads, each at its place in the plan.
ScatteredPoints points_of_task(const StepContext& given, const ScanTiles& tiles, std::size_t task);

// A task's share of the first level. Reads the input twice, or once where it reads slowly. Where the config
// has a resolution, one point is left for each cell of its lattice.
Level share_of_first_level(const StepContext& given, std::size_t task);

// The first level, all of it. Throws `Error`.
Level first_level(const StepContext& given);
bool is_first_level_kept(const StepContext& given);

}  // namespace lacuna
