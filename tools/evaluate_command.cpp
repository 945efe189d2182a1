#include "tools/evaluate_command.hpp"

#include "tools/accuracy/evaluation.hpp"
#include "tools/summary.hpp"
#include "tools/visible_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using namespace accuracy;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostRows = 20;

struct EvaluateArguments {
  fs::path result, truth, surface;
  std::vector<fs::path> scans;
  double tolerance = EvaluationRule{}.tolerance;
  std::int64_t min_vertices = EvaluationRule{}.min_vertices;
  bool json = false;
};

const char* name_of(EdgeDecision verdict) {
  switch (verdict) {
    case EdgeDecision::kFound:
      return "found";
    case EdgeDecision::kRepeated:
      return "repeated";
    case EdgeDecision::kShort:
      return "short";
    case EdgeDecision::kJoined:
      return "joined";
    case EdgeDecision::kParted:
      return "parted";
    case EdgeDecision::kUnsampled:
      return "unsampled";
    case EdgeDecision::kFalse:
      break;
  }
  return "false";
}

std::string print_number(double value, const char* format = "%.3f") {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string print_share(const std::optional<double>& value) {
  return value ? print_number(*value) : "-";
}

std::string print_index(const std::optional<std::size_t>& index) {
  return index ? std::to_string(*index) : "-";
}

void print_rows(std::vector<std::vector<std::string>> rows) {
  const std::size_t beyond = rows.size() > kMostRows + 1 ? rows.size() - kMostRows - 1 : 0;
  rows.resize(rows.size() - beyond);
  std::cout << "\n" << print_table(rows);
  if (beyond > 0) std::cout << "  and " << print_count(beyond) << " more: --json has them all\n";
}

std::string print_points(const PointScores& scores) {
  return "precision " + print_share(scores.precision) + ", recall " + print_share(scores.recall) + ", F1 " +
         print_share(scores.f1);
}

void print_scores(const EvaluateArguments& arguments, const Truth& truth, const Evaluation& evaluation) {
  const LoopScores& scores = evaluation.loops.scores;
  std::cout << visible(arguments.result.string()) << " against " << visible(arguments.truth.string())
            << "\n  true loops  " << print_count(scores.true_loops) << ", of " << arguments.min_vertices
            << " vertices or more; shorter ones: " << print_count(scores.short_loops) << "\n  found       "
            << print_count(scores.found) << "\n  missed      " << print_count(scores.missed)
            << "\n  loops       " << print_count(scores.loops) << "\n  false       "
            << print_count(scores.false_loops) << "\n  joined      " << print_count(scores.joined)
            << "\n  parted      " << print_count(scores.parted) << "\n  unsampled   "
            << (truth.surface ? print_count(scores.unsampled) : "-") << "\n  repeated    "
            << print_count(scores.repeated) << "\n  recall      " << print_share(scores.recall)
            << "\n  precision   " << print_share(scores.precision) << "\n  spacing     "
            << print_number(truth.spacing, "%.6g") << ", tolerance "
            << print_number(arguments.tolerance, "%g") << " spacings\n";
  if (evaluation.confidence) {
    std::cout << "  confidence  area under the ROC curve " << print_number(*evaluation.confidence) << "\n";
  }
  if (!evaluation.boundary) return;
  std::cout << "  boundary    " << print_count(evaluation.boundary->flagged) << " points flagged, "
            << print_count(evaluation.boundary->truth) << " true\n    same id   "
            << print_points(evaluation.boundary->by_id) << "\n    tolerance "
            << print_points(evaluation.boundary->within_radius) << "\n";
}

void print_loops(const Result& result, const Truth& truth, const Evaluation& evaluation) {
  std::vector<std::vector<std::string>> rows = {{"true loop", "vertices", "found by loop"}};
  for (std::size_t i = 0; i < truth.loops.size(); ++i) {
    const TrueMatch& match = evaluation.loops.true_loops[i];
    rows.push_back({std::to_string(i), print_count(truth.loops[i].vertices.size()),
                    match.found_by ? std::to_string(*match.found_by)
                    : match.counts ? "missed"
                                   : "-"});
  }
  if (rows.size() > 1) print_rows(std::move(rows));
  rows = {{"loop", "points", "verdict", "true loop", "on it", "covered", "on any", "at unsampled"}};
  for (std::size_t i = 0; i < result.loops.size(); ++i) {
    const LoopMatch& match = evaluation.loops.loops[i];
    rows.push_back({std::to_string(i), print_count(result.loops[i].size()), name_of(match.verdict),
                    print_index(match.true_loop), print_number(match.on), print_number(match.covered),
                    print_number(match.on_any), print_share(match.at_unsampled)});
  }
  if (rows.size() > 1) print_rows(std::move(rows));
}

void print_summary(const LoopScores& scores) {
  std::cout << "\nFound " << print_count(scores.found) << " of " << print_count(scores.true_loops)
            << " true loops. Of " << print_count(scores.loops) << " loops, "
            << print_count(scores.false_loops) << (scores.false_loops == 1 ? " is false" : " are false");
  for (const auto& [count, name] :
       {std::pair(scores.joined, "joined"), std::pair(scores.parted, "parted"),
        std::pair(scores.unsampled, "unsampled"), std::pair(scores.repeated, "repeated")}) {
    if (count > 0) std::cout << ", " << print_count(count) << " " << name;
  }
  std::cout << ".\n";
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json points_json(const PointScores& scores) {
  return {{"precision", or_null(scores.precision)},
          {"recall", or_null(scores.recall)},
          {"f1", or_null(scores.f1)}};
}

void print_json(const EvaluateArguments& arguments, const Result& result, const Truth& truth,
                const Evaluation& evaluation) {
  const LoopScores& scores = evaluation.loops.scores;
  Json root = {{"result", arguments.result.string()},
               {"truth", arguments.truth.string()},
               {"surface", truth.surface ? Json(arguments.surface.string()) : Json()},
               {"points", truth.positions.size()},
               {"spacing", truth.spacing},
               {"tolerance", arguments.tolerance},
               {"min_vertices", arguments.min_vertices},
               {"true", scores.true_loops},
               {"short", scores.short_loops},
               {"found", scores.found},
               {"missed", scores.missed},
               {"loops", scores.loops},
               {"false", scores.false_loops},
               {"repeated", scores.repeated},
               {"joined", scores.joined},
               {"parted", scores.parted},
               {"unsampled", scores.unsampled},
               {"recall", or_null(scores.recall)},
               {"precision", or_null(scores.precision)},
               {"confidence_auc", or_null(evaluation.confidence)},
               {"boundary", nullptr}};
  if (const auto& boundary = evaluation.boundary) {
    root["boundary"] = {{"flagged", boundary->flagged},
                        {"true", boundary->truth},
                        {"by_id", points_json(boundary->by_id)},
                        {"within_tolerance", points_json(boundary->within_radius)}};
  }
  root["true_loops"] = Json::array();
  for (std::size_t i = 0; i < truth.loops.size(); ++i) {
    const TrueMatch& match = evaluation.loops.true_loops[i];
    root["true_loops"].push_back({{"vertices", truth.loops[i].vertices.size()},
                                  {"counts", match.counts},
                                  {"found_by", or_null(match.found_by)}});
  }
  root["loop_matches"] = Json::array();
  for (std::size_t i = 0; i < result.loops.size(); ++i) {
    const LoopMatch& match = evaluation.loops.loops[i];
    root["loop_matches"].push_back({{"points", result.loops[i].size()},
                                    {"verdict", name_of(match.verdict)},
                                    {"true_loop", or_null(match.true_loop)},
                                    {"on_any", match.on_any},
                                    {"on", match.on},
                                    {"covered", match.covered},
                                    {"at_unsampled", or_null(match.at_unsampled)}});
  }
  // Names of files need not be UTF-8.
  std::cout << root.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
}

void run_evaluate(const EvaluateArguments& arguments) {
  if (!(arguments.tolerance >= 0 && std::isfinite(arguments.tolerance))) {
    throw CLI::ValidationError("--tolerance", "must be a number of spacings from 0 on");
  }
  if (arguments.min_vertices < 0) {
    throw CLI::ValidationError("--min-vertices", "must be a whole number from 0 on");
  }
  const Result result = read_result(arguments.result);
  Truth truth = read_truth(arguments.truth, {arguments.scans.begin(), arguments.scans.end()}, result);
  if (!arguments.surface.empty()) truth.surface = read_surface(arguments.surface);
  const Evaluation evaluation = evaluate(
      result, truth,
      {.tolerance = arguments.tolerance, .min_vertices = static_cast<std::size_t>(arguments.min_vertices)});
  if (arguments.json) {
    print_json(arguments, result, truth, evaluation);
  } else {
    print_scores(arguments, truth, evaluation);
    print_loops(result, truth, evaluation);
    print_summary(evaluation.loops.scores);
  }
}

}  // namespace

void add_evaluate_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("evaluate", "Hold found loops against the true ones");
  const auto arguments = std::make_shared<EvaluateArguments>();
  command
      ->add_option("RESULT", arguments->result,
                   "Output folder of lacuna detect, its loops.ply, or loops as text: ids, one loop per line")
      ->type_name("PATH")
      ->required();
  command
      ->add_option("TRUTH", arguments->truth,
                   "A PLY mesh, whose boundary is the truth, or loops as text: ids, one loop per line")
      ->type_name("FILE")
      ->required();
  command
      ->add_option(
          "--scan", arguments->scans,
          "Scan files that the ids of loops as text count; default: X.ply beside X.loops.txt, else the "
          "input of the run")
      ->type_name("FILE");
  command
      ->add_option("--surface", arguments->surface,
                   "A PLY mesh of the true surface; loops around places of it without points are not false")
      ->type_name("FILE");
  command
      ->add_option("--tolerance", arguments->tolerance,
                   "How far a loop may be off the true one, spacings of the scan, from 0 on")
      ->capture_default_str();
  command
      ->add_option("--min-vertices", arguments->min_vertices,
                   "True loops with fewer vertices count neither as found nor as missed")
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Print it as JSON");
  command->callback([arguments] { run_evaluate(*arguments); });
}

}  // namespace lacuna
