// SPDX-License-Identifier: Apache-2.0
// All scores of `lacuna-bench evaluate`, as tables.
#include "bench/evaluation/decision_names.hpp"
#include "bench/evaluation/print.hpp"
#include "tools/console/measures_text.hpp"
#include "tools/console/visible_text.hpp"

#include <cstdio>
#include <optional>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

namespace lacuna::evaluation {
using namespace tools;

namespace {

constexpr std::size_t kMostDetails = 20;

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

std::string print_rows(std::vector<std::vector<std::string>> rows) {
  const std::size_t beyond = rows.size() > kMostDetails + 1 ? rows.size() - kMostDetails - 1 : 0;
  rows.resize(rows.size() - beyond);
  std::string text = "\n" + print_table(rows);
  if (beyond > 0) text += "  and " + print_count(beyond) + " more: --json has them all\n";
  return text;
}

std::string print_points(const PointScores& scores) {
  return "precision " + print_share(scores.precision) + ", recall " + print_share(scores.recall) + ", F1 " +
         print_share(scores.f1);
}

std::string print_scores(const EvaluationText& text) {
  const Truth& truth = text.truth;
  const Evaluation& evaluation = text.evaluation;
  std::ostringstream out;
  const LoopScores& scores = evaluation.scores;
  out << visible(text.result_path.string()) << " against " << visible(text.truth_path.string())
      << "\n  true loops  " << print_count(scores.true_loops) << ", of " << text.rule.min_vertices
      << " vertices or more; shorter ones: " << print_count(scores.short_loops) << "\n  found       "
      << print_count(scores.found) << "\n  missed      " << print_count(scores.missed) << "\n  loops       "
      << print_count(scores.loops) << "\n  false       " << print_count(scores.false_loops)
      << "\n  joined      " << print_count(scores.joined) << "\n  parted      " << print_count(scores.parted)
      << "\n  step        " << (truth.steps.empty() ? "-" : print_count(scores.steps)) << "\n  unsampled   "
      << (truth.surface ? print_count(scores.unsampled) : "-") << "\n  repeated    "
      << print_count(scores.repeated) << "\n  recall      " << print_share(scores.recall)
      << "\n  precision   " << print_share(scores.precision) << "\n  spacing     "
      << print_number(truth.spacing, "%.6g") << ", tolerance " << print_number(text.rule.tolerance, "%g")
      << " spacings\n";
  if (evaluation.confidence) {
    out << "  confidence  area under the ROC curve " << print_number(*evaluation.confidence) << "\n";
  }
  if (!evaluation.boundary) return out.str();
  out << "  boundary    " << print_count(evaluation.boundary->flagged) << " points flagged, "
      << print_count(evaluation.boundary->truth) << " true\n    same id   "
      << print_points(evaluation.boundary->by_id) << "\n    tolerance "
      << print_points(evaluation.boundary->within_tolerance) << "\n";
  return out.str();
}

std::string print_loops(const EvaluationText& text) {
  const auto& [result, truth, evaluation] = std::tie(text.result, text.truth, text.evaluation);
  std::string tables;
  std::vector<std::vector<std::string>> rows = {{"true loop", "vertices", "found by loop"}};
  for (std::size_t i = 0; i < truth.loops.size(); ++i) {
    const TrueMatch& match = evaluation.loops.true_loops[i];
    rows.push_back({std::to_string(i), print_count(truth.loops[i].vertices.size()),
                    match.found_by ? std::to_string(*match.found_by)
                    : match.counts ? "missed"
                                   : "-"});
  }
  if (rows.size() > 1) tables += print_rows(std::move(rows));
  rows = {
      {"loop", "points", "verdict", "true loop", "on it", "covered", "on any", "on step", "at unsampled"}};
  for (std::size_t i = 0; i < result.loops.size(); ++i) {
    const LoopMatch& match = evaluation.loops.loops[i];
    rows.push_back({std::to_string(i), print_count(result.loops[i].size()), name_of(match.verdict),
                    print_index(match.true_loop), print_number(match.on), print_number(match.covered),
                    print_number(match.on_any), print_share(match.on_step), print_share(match.at_unsampled)});
  }
  if (rows.size() > 1) tables += print_rows(std::move(rows));
  return tables;
}

std::string print_conclusion(const LoopScores& scores) {
  std::ostringstream out;
  out << "\nFound " << print_count(scores.found) << " of " << print_count(scores.true_loops)
      << " true loops. Of " << print_count(scores.loops) << " loops, " << print_count(scores.false_loops)
      << (scores.false_loops == 1 ? " is false" : " are false");
  for (const auto& [count, name] :
       {std::pair(scores.joined, "joined"), std::pair(scores.parted, "parted"),
        std::pair(scores.steps, scores.steps == 1 ? "step" : "steps"),
        std::pair(scores.unsampled, "unsampled"), std::pair(scores.repeated, "repeated")}) {
    if (count > 0) out << ", " << print_count(count) << " " << name;
  }
  out << ".\n";
  return out.str();
}

}  // namespace

std::string print_details(const EvaluationText& text) {
  return print_scores(text) + print_loops(text) + print_conclusion(text.evaluation.scores);
}

}  // namespace lacuna::evaluation
