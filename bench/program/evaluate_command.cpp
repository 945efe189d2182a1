// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/evaluation.hpp"
#include "bench/evaluation/print.hpp"
#include "bench/program/commands.hpp"
#include "tools/console/command_line.hpp"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace lacuna::bench {
using namespace tools;
namespace {

namespace fs = std::filesystem;
using namespace evaluation;

struct EvaluateArguments {
  fs::path result, truth, surface;
  std::vector<fs::path> scans;
  double tolerance = EvaluationRule{}.tolerance;
  std::size_t min_vertices = EvaluationRule{}.min_vertices;
  bool verbose = false;
  bool json = false;
};

void run_evaluate(const EvaluateArguments& arguments) {
  if (!(arguments.tolerance >= 0 && std::isfinite(arguments.tolerance))) {
    throw WrongOption("--tolerance", "must be a number of spacings from 0 on");
  }
  Result result = read_result(arguments.result);
  Truth truth = read_truth(arguments.truth, {arguments.scans.begin(), arguments.scans.end()}, result);
  if (!arguments.surface.empty()) truth.surface = read_surface(arguments.surface);
  const EvaluationRule rule{.tolerance = arguments.tolerance, .min_vertices = arguments.min_vertices};
  const Evaluation evaluation = evaluate(result, truth, rule);
  const EvaluationText text{.result = result,
                            .truth = truth,
                            .evaluation = evaluation,
                            .result_path = arguments.result,
                            .truth_path = arguments.truth,
                            .surface_path = arguments.surface,
                            .rule = rule};
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
  command
      .add_option("--tolerance", a.tolerance,
                  "How far a loop may be off the true one, spacings of the scan, from 0 on")
      .real_number()
      .show_default();
  command
      .add_option("--min-vertices", a.min_vertices,
                  "True loops with fewer vertices count neither as found nor as missed")
      .whole_number()
      .show_default();
  command.add_flag("--verbose", a.verbose, "Print all scores, and the decision on every loop, too");
  command.add_flag("--json", a.json, "Print it as JSON");
  command.runs([arguments] { run_evaluate(*arguments); });
}

}  // namespace lacuna::bench
