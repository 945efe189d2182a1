// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/evaluation.hpp"
#include "bench/evaluation/print.hpp"
#include "bench/program/commands.hpp"
#include "bench/program/rule_options.hpp"
#include "tools/console/command_line.hpp"

#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

#include <CLI/CLI.hpp>

namespace lacuna::bench {
using namespace tools;
namespace {

namespace fs = std::filesystem;
using namespace evaluation;

struct EvaluateArguments {
  fs::path result, truth;
  std::vector<fs::path> scans;
  EvaluationRule rule;
  bool json = false;
};

void run_evaluate(const EvaluateArguments& arguments) {
  check(arguments.rule);
  Result result = read_result(arguments.result);
  const Truth truth = read_truth(arguments.truth, {arguments.scans.begin(), arguments.scans.end()}, result);
  const Evaluation evaluation = evaluate(result, truth, arguments.rule);
  const EvaluationText text{.result = result,
                            .truth = truth,
                            .evaluation = evaluation,
                            .result_path = arguments.result,
                            .truth_path = arguments.truth,
                            .rule = arguments.rule};
  std::cout << (arguments.json ? print_json(text) : print_verdict(text));
}

}  // namespace

void add_evaluate_command(CLI::App& program) {
  CLI::App& command = *program.add_subcommand("evaluate", "Compare the loops found with the true loops");
  const auto arguments = std::make_shared<EvaluateArguments>();
  EvaluateArguments& a = *arguments;
  command
      .add_option("RESULT", a.result,
                  "Output folder of lacuna detect, its loops.ply, loops as text (ids, one loop per line), or "
                  "closed lines of a PLY file (element edge)")
      ->type_name("PATH")
      ->required();
  command
      .add_option("TRUTH", a.truth,
                  "A PLY mesh, whose boundary is the truth, or loops as text: ids, one loop per line")
      ->type_name("FILE")
      ->required();
  command
      .add_option(
          "--scan", a.scans,
          "Scan files that the ids of loops as text count; default: X.ply next to X.loops.txt, else the "
          "input of the run")
      ->type_name("FILE");
  add_rule_options(command, a.rule);
  command.add_flag("--json", a.json, "Print all scores, and the decision on every loop, as JSON");
  command.callback([arguments] { run_evaluate(*arguments); });
}

}  // namespace lacuna::bench
