// lacuna report: the page of a finished run.
#pragma once

namespace CLI {
class App;
}

namespace lacuna {

void add_report_command(CLI::App& app);

}  // namespace lacuna
