// SPDX-License-Identifier: Apache-2.0
// survey, over the whole scan: finds where the points are.
#pragma once

#include "engine/config/job.hpp"
#include "engine/model/points.hpp"
#include "engine/model/task_share.hpp"
#include "engine/survey/survey.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

namespace lacuna {

// Streams the scan once and counts its points per cell. Throws `Error`.
SurveyedScan survey_scan(PointSource& scan, Job& job);

// Several tasks may survey parts of the scan. Returns the counts of some parts, which `merge_surveys` merges
// in the order of the parts. Ids count from the first of these points.
SurveyedScan survey_parts(PointSource& scan, const IndexRange& parts, Job& job);
// Returns the survey of the whole scan. `expected_points`: as of the source.
SurveyedScan merge_surveys(std::size_t tasks, const std::function<SurveyedScan(std::size_t)>& survey_of_task,
                           std::optional<std::uint64_t> expected_points, const Spill& spill,
                           const Memory& memory);

}  // namespace lacuna
