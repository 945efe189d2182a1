// SPDX-License-Identifier: Apache-2.0
// lacuna report: the page of a finished run.
#pragma once

namespace CLI {
class App;
}

namespace lacuna::tools {

void add_report_command(CLI::App& app);

}  // namespace lacuna::tools
