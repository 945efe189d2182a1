// SPDX-License-Identifier: Apache-2.0
// The steps that bring the scan into its first level: survey, tiles, bucket, thin. One process does them, or
// several tasks that each read parts of the scan.
#pragma once

#include "engine/bucket/set_aside.hpp"
#include "engine/bucket/split.hpp"
#include "engine/config/job.hpp"
#include "engine/model/points.hpp"
#include "engine/parts/parts.hpp"
#include "engine/survey/survey.hpp"
#include "engine/thin/level.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

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

// The counts of the points that a task reads.
struct TaskSurvey {
  SurveyedScan survey;
  std::vector<std::uint64_t> pass_counts;  // `PointSource::pass_counts`
  std::string seal;                        // the checksum of its part, a line; empty: it is not kept
};

// The tiles of the scan, from all counts.
struct ScanTiles {
  TilePlan plan;
  SurveyTotals survey;                     // of the whole scan
  std::vector<std::uint64_t> pass_counts;  // of the whole scan
  std::vector<std::uint64_t> first_ids;    // of each task's points
  std::string seal;
};

TaskSurvey survey_of_task(const StepContext& context, std::size_t task);

ScanTiles tiles_of_scan(const StepContext& context);

// The points that a task reads, each at its place in the plan.
ScatteredPoints points_of_task(const StepContext& context, const ScanTiles& tiles, std::size_t task);

// A task's share of the first level. Reads the input twice, or once where it reads slowly. Where the config
// has a resolution, one point is left for each cell of its lattice.
Level share_of_first_level(const StepContext& context, std::size_t task);

// The first level, all of it. Throws `Error`.
Level first_level(const StepContext& context);
bool is_first_level_kept(const StepContext& context);

}  // namespace lacuna
