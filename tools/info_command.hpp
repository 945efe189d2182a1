// SPDX-License-Identifier: Apache-2.0
// `lacuna info`: what scan files hold, and what a run on them would take.
#pragma once

namespace CLI {
class App;
}

namespace lacuna::tools {

// It runs when parsed. Throws `Error` when a file cannot be read, `CLI::Error` for wrong usage.
void add_info_command(CLI::App& app);

}  // namespace lacuna::tools
