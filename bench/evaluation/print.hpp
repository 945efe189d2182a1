// SPDX-License-Identifier: Apache-2.0
// print: the output of `lacuna-bench evaluate` and `lacuna-bench score`, for people and as JSON.
#pragma once

#include "bench/evaluation/cloud_score.hpp"
#include "bench/evaluation/evaluation.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lacuna::evaluation {

// ---- One result

struct EvaluationText {
  const Result& result;
  const Truth& truth;
  const Evaluation& evaluation;
  std::filesystem::path result_path, truth_path;
  EvaluationRule rule;
};

// Prints one sentence with the numbers of found and false loops, and the holes found by width. Then it prints
// a line for each true loop, the largest first, with its name, size, place, and what found it. Then it prints
// a line for each loop that matches no true loop.
std::string print_verdict(const EvaluationText& text);

// Returns all scores, and every number behind them, by loop.
std::string print_json(const EvaluationText& text);

// ---- Many clouds

// By kind of cloud. There is at least one kind, and each has a cloud.
using ScoresByKind = std::map<std::string, std::vector<CloudScore>>;

// What was scored, for the JSON.
struct ScoredFolders {
  std::filesystem::path clouds, results;
  std::vector<std::filesystem::path> without_result;
  EvaluationRule rule;
};

// Prints three tables, per hole, per area and per point. Each has a row for each kind, and one for all.
std::string print_scores(const ScoresByKind& kinds);
// Returns every number of the tables, and those behind them.
std::string print_json(const ScoresByKind& kinds, const ScoredFolders& folders);

}  // namespace lacuna::evaluation
