// lacuna render: a picture of a finished run.
#pragma once

namespace CLI {
class App;
}

namespace lacuna {

void add_render_command(CLI::App& app);

}  // namespace lacuna
