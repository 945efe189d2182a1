// SPDX-License-Identifier: Apache-2.0
#include "tools/run/run_steps.hpp"

#include "engine/thin/thin.hpp"

namespace lacuna::tools {

RunSteps steps_of_run(const Config& config, bool has_area) {
  RunSteps steps = all_steps();
  std::erase_if(steps, [&](std::string_view step) {
    if (step == "thin") return first_edge(config.scale) == 0;
    if (step == "levels" || step == "track") return !has_levels(config);
    if (step == "orient") return !config.normals.orient;
    if (step == "area" || step == "voids") return !has_area;
    return false;
  });
  return steps;
}

}  // namespace lacuna::tools
