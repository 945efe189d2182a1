// SPDX-License-Identifier: Apache-2.0
// A scan on its way into the first level, in a workspace, where several tasks read it. Each has parts of the
// scan: first it surveys them, and then it scatters their points to the tiles of a common plan.
#pragma once

#include "engine/bucket/scattered_points.hpp"
#include "engine/bucket/split.hpp"
#include "engine/model/task_share.hpp"
#include "engine/run/job.hpp"
#include "engine/survey/survey.hpp"
#include "engine/workspace/workspace.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lacuna {

// What a task has surveyed.
struct SealedSurvey {
  SurveyedScan survey;
  std::vector<std::uint64_t> pass_counts;  // `PointSource::pass_counts`
  std::string seal;                        // the checksum of its part, a line
};
void seal_survey(const SurveyedScan& survey, const std::vector<std::uint64_t>& pass_counts,
                 const TaskShare& share, const Workspace& workspace);
std::optional<SealedSurvey> open_survey(const TaskShare& share, const Workspace& workspace);
// Returns the checksums of the surveys of all tasks, a line each. Returns nothing where one is not there.
std::optional<std::string> seals_of_surveys(std::size_t tasks, const Workspace& workspace);

// The tiles of the scan, from all surveys.
struct SealedPlan {
  TilePlan plan;
  SurveyTotals survey;                     // of the whole scan
  std::vector<std::uint64_t> pass_counts;  // of the whole scan
  std::vector<std::uint64_t> first_ids;    // of each task's points
  std::string seal;
};
void seal_plan(SealedPlan& plan, const std::string& made_from, const Workspace& workspace);
std::optional<SealedPlan> open_plan(const std::string& made_from, const Workspace& workspace);

// The points of a task by their places.
void seal_scattered(const ScatteredPoints& points, const TaskShare& share, const std::string& made_from,
                    const Workspace& workspace);
std::optional<PartReader> open_scattered(const TaskShare& share, const std::string& made_from,
                                         const Workspace& workspace);
void visit_scattered(const PartReader& part, std::size_t place, const PointForm& form,
                     const VisitPoints& visit);

// Removes all these parts, once the first level is whole.
void remove_scan_parts(const Workspace& workspace);

}  // namespace lacuna
