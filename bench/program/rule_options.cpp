// SPDX-License-Identifier: Apache-2.0
#include "bench/program/rule_options.hpp"

#include "tools/console/command_line.hpp"

#include <cmath>

#include <CLI/CLI.hpp>

namespace lacuna::bench {

void add_rule_options(CLI::App& command, evaluation::EvaluationRule& rule) {
  command
      .add_option("--tolerance", rule.tolerance,
                  "How far a loop may be off the true one, in spacings from 0 on; docs/evaluate.md")
      ->check(real_number())
      ->capture_default_str();
  command
      .add_option("--min-vertices", rule.min_vertices,
                  "True loops with fewer vertices count neither as found nor as missed")
      ->check(whole_number())
      ->capture_default_str();
}

void check(const evaluation::EvaluationRule& rule) {
  if (!(rule.tolerance >= 0 && std::isfinite(rule.tolerance)))
    throw tools::WrongOption("--tolerance", "must be a number of spacings from 0 on");
}

}  // namespace lacuna::bench
