// SPDX-License-Identifier: Apache-2.0
// `lacuna-bench evaluate`: how much of the truth a result has found.
#pragma once

namespace CLI {
class App;
}

namespace lacuna::bench {

// It runs when parsed. Throws `Error` for bad input, `CLI::Error` for wrong usage.
void add_evaluate_command(CLI::App& app);

}  // namespace lacuna::bench
