// SPDX-License-Identifier: Apache-2.0
// How much of a run is done, from the step that it is at.
#pragma once

#include "engine/config/config.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace lacuna::tools {

// The names of steps, in the order in which a run begins them.
using RunSteps = std::vector<std::string_view>;

// Returns the steps of a run that finds holes, and then checks an area if it has one.
RunSteps steps_of_run(const Config& config, bool has_area);
// Returns the steps of a check of an area.
RunSteps steps_of_check();

// Returns the share of the run's time that is over, from 0 to 1, once `step_share` of a step is done. The
// steps before it count as done, whether they took place or not. Each has a weight, so the share is rough.
// It is empty where the run has no such step.
std::optional<double> run_share(const RunSteps& steps, std::string_view step, double step_share);

}  // namespace lacuna::tools
