// SPDX-License-Identifier: Apache-2.0
// `lacuna find-stations`: where scanners stood, from single sweeps.
#pragma once

#include <CLI/CLI.hpp>

namespace lacuna::tools {

void add_find_stations_command(CLI::App& app);

}  // namespace lacuna::tools
