// SPDX-License-Identifier: Apache-2.0
// The commands that compare loops with the truth: `evaluate` for one scan, `score` for a folder.
#include "bench/evaluation/evaluation.hpp"
#include "bench/program/commands.hpp"
#include "engine/run/error.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/terminal.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace lacuna::bench {

using namespace tools;
using namespace evaluation;
namespace fs = std::filesystem;

namespace {

void add_rule_options(CLI::App& command, EvaluationRule& rule) {
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

void check(const EvaluationRule& rule) {
  if (!(rule.tolerance >= 0 && std::isfinite(rule.tolerance)))
    throw WrongOption("--tolerance", "must be a number of spacings from 0 on");
}

// ---- evaluate

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
  const EvaluationText text{result, truth, evaluation, arguments.result, arguments.truth, arguments.rule};
  std::cout << (arguments.json ? print_json(text) : print_verdict(text));
}

// ---- score

struct ScoreArguments {
  fs::path clouds, results;
  EvaluationRule rule;
  bool each = false, json = false;
};

// Returns the PLY files of the folder, by name.
std::vector<fs::path> clouds_in(const fs::path& folder) {
  std::error_code failure;
  std::vector<fs::path> clouds;
  for (fs::directory_iterator file(folder, failure), end; !failure && file != end; file.increment(failure)) {
    if (file->path().extension() == ".ply") clouds.push_back(file->path());
  }
  if (failure) throw Error(folder.string() + ": cannot be read: " + failure.message());
  if (clouds.empty()) throw Error(folder.string() + ": has no cloud, which is a file X.ply");
  std::sort(clouds.begin(), clouds.end());
  return clouds;
}

// Returns the loops for a cloud X: X.txt, X.ply or the folder X. Empty if there is none.
fs::path result_for(const fs::path& cloud, const fs::path& results) {
  for (const char* ending : {".txt", ".ply", ""}) {
    const fs::path result = results / (cloud.stem().string() + ending);
    if (fs::exists(result)) return result;
  }
  return {};
}

// The truth of X.ply is X.loops.txt, else the boundary of its own faces.
fs::path truth_of(const fs::path& cloud) {
  const fs::path loops = fs::path(cloud).replace_extension(".loops.txt");
  return fs::exists(loops) ? loops : cloud;
}

void run_score(const ScoreArguments& arguments) {
  check(arguments.rule);
  ScoresByKind kinds;
  std::vector<fs::path> without_result;
  const std::vector<fs::path> clouds = clouds_in(arguments.clouds);
  for (const fs::path& cloud : clouds) {
    const fs::path file = result_for(cloud, arguments.results);
    if (file.empty()) without_result.push_back(cloud);
    Result result = file.empty() ? Result{} : read_result(file);
    const Truth truth = read_truth(truth_of(cloud), {}, result);
    const std::string name = cloud.stem().string();
    kinds[arguments.each ? name : name.substr(0, name.find_first_of("-_"))].push_back(
        score_cloud(result, truth, arguments.rule));
  }
  if (without_result.size() == clouds.size()) {
    throw Error(arguments.results.string() + ": has no loops for any cloud of " + arguments.clouds.string() +
                "; those of " + clouds.front().filename().string() + " would be in " +
                clouds.front().stem().string() + ".txt");
  }
  if (arguments.json) {
    std::cout << print_json(kinds, {arguments.clouds, arguments.results, without_result, arguments.rule});
    return;
  }
  if (!without_result.empty()) {
    std::cout << "no loops for " << print_count(without_result.size()) << " of " << print_count(clouds.size())
              << " clouds, such as " << visible(without_result.front().string()) << "\n\n";
  }
  std::cout << print_scores(kinds);
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

void add_score_command(CLI::App& program) {
  CLI::App& command = *program.add_subcommand("score", "Score a program's loops for a folder of clouds");
  const auto arguments = std::make_shared<ScoreArguments>();
  ScoreArguments& a = *arguments;
  command
      .add_option("DIR", a.clouds,
                  "Folder of clouds X.ply with true loops X.loops.txt, as `make` writes it; without "
                  "X.loops.txt, X.ply is a mesh, whose boundary is the truth")
      ->required();
  command
      .add_option("RESULTS", a.results,
                  "Folder of loops: for each cloud X the file X.txt (ids, one loop per line), X.ply (closed "
                  "lines), or the folder X of lacuna detect")
      ->type_name("DIR")
      ->required();
  add_rule_options(command, a.rule);
  command.add_flag("--each", a.each, "Print a row for each cloud instead of each kind");
  command.add_flag("--json", a.json, "Print every number as JSON");
  command.callback([arguments] { run_score(*arguments); });
}

}  // namespace lacuna::bench
