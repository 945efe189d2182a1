// SPDX-License-Identifier: Apache-2.0
// `lacuna-bench synth`: makes scans to try Lacuna on.
#pragma once

namespace CLI {
class App;
}

namespace lacuna::bench {

// Adds `synth surface` and `synth scan`; they run when parsed. Throws `Error` for values that cannot be.
void add_synth_command(CLI::App& app);

}  // namespace lacuna::bench
