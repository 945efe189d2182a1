// SPDX-License-Identifier: Apache-2.0
// Scores of a result, from the loops that match true ones.
#pragma once

#include "io/explain/matching/match_loops.hpp"

#include <cstddef>
#include <optional>
#include <span>

namespace lacuna::evaluation {
using namespace matching;

struct LoopScores {
  std::size_t true_loops = 0, found = 0, missed = 0;  // of the true loops that count
  std::size_t short_loops = 0;                        // true ones that do not count
  std::size_t loops = 0, false_loops = 0, repeated = 0, joined = 0, parted = 0, steps = 0;
  std::optional<double> recall;  // share of the true ones that are found; empty without true ones
  std::optional<double>
      precision;  // neither false, joined nor parted of the loops but steps; empty without such loops
};

LoopScores score_loops(std::span<const LoopMatch> loops, std::span<const TrueMatch> true_loops);

// The probability that a loop that matches a true one has a higher confidence than a false one, ties being
// half. This is the area under the ROC curve. Loops without a confidence (NaN) take no part, and neither do
// loops that are neither right nor wrong (short, joined, parted, step). There is no value where
// either kind is missing.
std::optional<double> area_under_roc(std::span<const LoopMatch> loops, std::span<const double> confidence);

}  // namespace lacuna::evaluation
