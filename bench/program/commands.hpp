// SPDX-License-Identifier: Apache-2.0
// The commands of `lacuna-bench`. Each function adds one to the program. The command runs when it is parsed.
// It throws `Error` when the job fails, and `UsageError` for options that are not possible.
#pragma once

namespace CLI {
class App;
}

namespace lacuna::bench {

void add_synth_command(CLI::App& program);     // makes scans with known holes
void add_evaluate_command(CLI::App& program);  // compares a result with the truth
void add_make_command(CLI::App& program);      // makes a folder of clouds and truth
void add_score_command(CLI::App& program);     // scores results for such a folder

}  // namespace lacuna::bench
