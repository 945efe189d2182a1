// SPDX-License-Identifier: Apache-2.0
// `lacuna stations`: where to stand next, for the results in a folder.
#pragma once

#include <CLI/CLI.hpp>

namespace lacuna::tools {

void add_stations_command(CLI::App& app);

}  // namespace lacuna::tools
