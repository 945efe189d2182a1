// SPDX-License-Identifier: Apache-2.0
// lacuna plan, work and finish: a run that several processes share, such as a job array of Slurm.
#pragma once

#include <CLI/CLI.hpp>

namespace lacuna::tools {

void add_plan_command(CLI::App& app);
void add_work_command(CLI::App& app);
void add_finish_command(CLI::App& app);

}  // namespace lacuna::tools
