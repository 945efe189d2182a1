// SPDX-License-Identifier: Apache-2.0
// lacuna render: a picture of a finished run.
#pragma once

namespace CLI {
class App;
}

namespace lacuna::tools {

void add_render_command(CLI::App& app);

}  // namespace lacuna::tools
