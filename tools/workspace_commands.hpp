// SPDX-License-Identifier: Apache-2.0
// lacuna status and lacuna clean: what a workspace has, and its end.
#pragma once

#include "engine/workspace/workspace_state.hpp"

#include <string>

#include <CLI/CLI.hpp>

namespace lacuna::tools {

// "level 0: 12 of 20 tiles evaluated; level 1: ..."
std::string print_state(const WorkspaceState& state);

void add_status_command(CLI::App& app);
void add_clean_command(CLI::App& app);

}  // namespace lacuna::tools
