// SPDX-License-Identifier: Apache-2.0
// The options that say when a loop is found.
#pragma once

#include "bench/evaluation/evaluation.hpp"

namespace CLI {
class App;
}

namespace lacuna::bench {

// The rule outlives the command.
void add_rule_options(CLI::App& command, evaluation::EvaluationRule& rule);

// Throws `UsageError` for a rule that is not possible.
void check(const evaluation::EvaluationRule& rule);

}  // namespace lacuna::bench
