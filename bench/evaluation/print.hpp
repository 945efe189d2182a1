// SPDX-License-Identifier: Apache-2.0
// The output of `lacuna-bench evaluate`: for people, and as JSON.
#pragma once

#include "bench/evaluation/evaluation.hpp"

#include <filesystem>
#include <string>

namespace lacuna::evaluation {

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

}  // namespace lacuna::evaluation
