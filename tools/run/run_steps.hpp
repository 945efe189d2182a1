// SPDX-License-Identifier: Apache-2.0
// Which steps a run has.
#pragma once

#include "engine/config/config.hpp"
#include "tools/console/run_share.hpp"

namespace lacuna::tools {

// Returns the steps of a run that finds holes, and then checks an area if it has one.
RunSteps steps_of_run(const Config& config, bool has_area);

}  // namespace lacuna::tools
