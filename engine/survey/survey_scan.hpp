// SPDX-License-Identifier: Apache-2.0
// survey, over the whole scan: finds where the points are.
#pragma once

#include "engine/model/points.hpp"
#include "engine/run/job.hpp"
#include "engine/survey/survey.hpp"

namespace lacuna {

// Streams the scan once and counts its points per cell. Throws `Error`.
SurveyedScan survey_scan(PointSource& scan, Job& job);

}  // namespace lacuna
