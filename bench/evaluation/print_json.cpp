// SPDX-License-Identifier: Apache-2.0
// The output of `lacuna-bench evaluate --json`.
#include "bench/evaluation/json.hpp"
#include "bench/evaluation/loop_size.hpp"
#include "bench/evaluation/print.hpp"

#include <optional>
#include <string_view>
#include <tuple>

namespace lacuna::evaluation {
namespace {

// The words for the decision on a loop, as docs/evaluate.md defines them.
std::string_view name_of(EdgeDecision verdict) {
  constexpr std::string_view kNames[] = {"found", "repeated", "short", "joined", "parted", "step", "false"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::optional<std::string> name_of(const TrueLoop& loop) {
  return loop.name.empty() ? std::nullopt : std::optional(loop.name);
}

}  // namespace

std::string print_json(const EvaluationText& text) {
  const auto& [result, truth, evaluation] = std::tie(text.result, text.truth, text.evaluation);
  const LoopScores& scores = evaluation.scores;
  Json root = {{"result", text.result_path.string()},
               {"truth", text.truth_path.string()},
               {"points", truth.positions.size()},
               {"spacing", truth.spacing},
               {"tolerance", text.rule.tolerance},
               {"min_vertices", text.rule.min_vertices},
               {"true", scores.true_loops},
               {"short", scores.short_loops},
               {"found", scores.found},
               {"missed", scores.missed},
               {"loops", scores.loops},
               {"false", scores.false_loops},
               {"repeated", scores.repeated},
               {"joined", scores.joined},
               {"parted", scores.parted},
               {"step", scores.steps},
               {"recall", or_null(scores.recall)},
               {"precision", or_null(scores.precision)},
               {"confidence_auc", or_null(evaluation.confidence)},
               {"boundary", nullptr}};
  if (const auto& boundary = evaluation.boundary) {
    root["boundary"] = {{"flagged", boundary->flagged},
                        {"true", boundary->truth},
                        {"by_id", json_of(boundary->by_id)},
                        {"within_tolerance", json_of(boundary->within_tolerance)}};
  }
  root["holes_by_width"] = Json::array();
  for (std::size_t i = 0; i < kWidths.size(); ++i) {
    root["holes_by_width"].push_back({{"from", kWidths[i]},
                                      {"to", i + 1 < kWidths.size() ? Json(kWidths[i + 1]) : Json()},
                                      {"true", evaluation.holes[i].all},
                                      {"found", evaluation.holes[i].found}});
  }
  root["true_loops"] = Json::array();
  for (std::size_t i = 0; i < truth.loops.size(); ++i) {
    const TrueMatch& match = evaluation.loops.true_loops[i];
    const LoopSize size = size_of(truth.loops[i], truth.positions);
    const auto& kind = truth.loops[i].kind;
    root["true_loops"].push_back({{"name", or_null(name_of(truth.loops[i]))},
                                  {"kind", kind ? Json(name_of(*kind)) : Json()},
                                  {"vertices", truth.loops[i].vertices.size()},
                                  {"perimeter", size.perimeter},
                                  {"diameter", size.diameter},
                                  {"width", or_null(truth.hole_widths[i])},
                                  {"centre", {size.centre.x(), size.centre.y(), size.centre.z()}},
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
                                    {"on_step", or_null(match.on_step)}});
  }
  return io::print(root, 2) + "\n";
}

}  // namespace lacuna::evaluation
