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

namespace lacuna::bench {
using namespace tools;
namespace {

namespace fs = std::filesystem;
using namespace evaluation;

struct EvaluateArguments {
  fs::path result, truth, surface;
  std::vector<fs::path> scans;
  EvaluationRule rule;
  bool verbose = false;
  bool json = false;
};

void run_evaluate(const EvaluateArguments& arguments) {
  check(arguments.rule);
  Result result = read_result(arguments.result);
  Truth truth = read_truth(arguments.truth, {arguments.scans.begin(), arguments.scans.end()}, result);
  if (!arguments.surface.empty()) truth.surface = read_surface(arguments.surface);
  const Evaluation evaluation = evaluate(result, truth, arguments.rule);
  const EvaluationText text{.result = result,
                            .truth = truth,
                            .evaluation = evaluation,
                            .result_path = arguments.result,
                            .truth_path = arguments.truth,
                            .surface_path = arguments.surface,
                            .rule = arguments.rule};
  if (arguments.json) {
    std::cout << print_json(text);
  } else {
    std::cout << print_verdict(text);
    if (arguments.verbose) std::cout << "\n" << print_details(text);
  }
}

}  // namespace

void add_evaluate_command(const Command& program) {
  const Command command = program.add_command("evaluate", "Compare the loops found with the true loops");
  const auto arguments = std::make_shared<EvaluateArguments>();
  EvaluateArguments& a = *arguments;
  command
      .add_option("RESULT", a.result,
                  "Output folder of lacuna detect, its loops.ply, loops as text (ids, one loop per line), or "
                  "closed lines of a PLY file (element edge)")
      .type("PATH")
      .required();
  command
      .add_option("TRUTH", a.truth,
                  "A PLY mesh, whose boundary is the truth, or loops as text: ids, one loop per line")
      .type("FILE")
      .required();
  command
      .add_option(
          "--scan", a.scans,
          "Scan files that the ids of loops as text count; default: X.ply next to X.loops.txt, else the "
          "input of the run")
      .type("FILE");
  command
      .add_option("--surface", a.surface,
                  "A PLY mesh of the true surface; loops around places of it without points are not false")
      .type("FILE");
  add_rule_options(command, a.rule);
  command.add_flag("--verbose", a.verbose, "Print all scores, and the decision on every loop, too");
  command.add_flag("--json", a.json, "Print it as JSON");
  command.runs([arguments] { run_evaluate(*arguments); });
}

}  // namespace lacuna::bench
