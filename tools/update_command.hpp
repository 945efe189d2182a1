// SPDX-License-Identifier: Apache-2.0
// lacuna update: a run whose input has changed in places.
#pragma once

#include <CLI/CLI.hpp>

namespace lacuna::tools {

void add_update_command(CLI::App& app);

}  // namespace lacuna::tools
