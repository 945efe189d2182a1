// SPDX-License-Identifier: Apache-2.0
// Decides which true loops were found, and which loops are false.
#pragma once

#include "tools/matching/true_loops.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace lacuna::matching {

// A loop lies on a true loop if `share` of its points are within the tolerance of an edge of the true loop.
// It covers the true loop if `share` of the true loop's vertices are within the tolerance of an edge of the
// loop. It matches if both hold.
//
// A loop that matches none may lie on all true loops that count together. Then `share` of its points are
// within the tolerance of an edge of any. Such a loop is `joined` if it covers one of them, or lies on no
// single one; then it runs along several. Else it is `parted`: it lies on one, and covers too little of it.
struct MatchRule {
  double tolerance = 0;  // a length
  double share = 0.7;
  std::size_t min_vertices = 8;  // true loops with fewer do not count
};

enum class EdgeDecision {
  kFound,      // the first loop that matches its true loop
  kRepeated,   // a later one
  kShort,      // matches only a true loop that does not count: neither right nor wrong
  kJoined,     // matches none, but runs along several that count
  kParted,     // matches none, but is a part of one that counts
  kStep,       // along a step of density; match_loops does not know it
  kUnsampled,  // around a place of the surface without points; match_loops does not know it
  kFalse,      // nothing of the above
};

struct LoopMatch {
  EdgeDecision verdict = EdgeDecision::kFalse;
  // The best of the true loops that it matches: counting before short, then by the smaller share, then by
  // both, then the first. For a joined loop it is the one of which it covers most, for a parted one the one
  // on which most of it lies. For a false loop it is the best of all that are near. Empty if no true loop is
  // near.
  std::optional<std::size_t> true_loop;
  double on_any = 0;                   // share of its points on the true loops that count
  double on = 0;                       // share of its points on that true loop
  double covered = 0;                  // share of that true loop's vertices on it
  std::optional<double> on_step;       // share of its points on steps of density
  std::optional<double> at_unsampled;  // share of its points at an unsampled place inside it
};

struct TrueMatch {
  bool counts = true;
  std::optional<std::size_t> found_by;  // the first loop that matches; empty if missed
};

struct LoopScores {
  std::size_t true_loops = 0, found = 0, missed = 0;  // of the true loops that count
  std::size_t short_loops = 0;                        // true ones that do not count
  std::size_t loops = 0, false_loops = 0, repeated = 0, joined = 0, parted = 0, steps = 0, unsampled = 0;
  std::optional<double> recall;  // share of the true ones that are found; empty without true ones
  std::optional<double>
      precision;  // neither false, joined nor parted of the loops but steps; empty without such loops
};

struct LoopAccuracy {
  std::vector<LoopMatch> loops;       // in the order given
  std::vector<TrueMatch> true_loops;  // in the order given
  LoopScores scores;
};

// Ids are places in `positions`. Cost: n log n, but the product of the numbers of loops if all loops are near
// one another.
LoopAccuracy match_loops(std::span<const io::LoopIds> loops, std::span<const TrueLoop> truth,
                         std::span<const Eigen::Vector3d> positions, const MatchRule& rule);

LoopScores score_loops(std::span<const LoopMatch> loops, std::span<const TrueMatch> true_loops);

// Decides on false loops once more. A loop becomes `verdict` if `share` of its points are `at(loop, point)`,
// both counted from 0. It becomes joined if `share` of them are there or near a true loop that counts. The
// function calls `at` for false loops alone. The share of points at `at` goes into that member of the loop's
// match. Cost: n log n, and the calls of `at`.
void decide_false_loops(std::span<const io::LoopIds> loops, std::span<const TrueLoop> truth,
                        std::span<const Eigen::Vector3d> positions, const MatchRule& rule,
                        EdgeDecision verdict, std::optional<double> LoopMatch::*share,
                        const std::function<bool(std::size_t loop, std::size_t point)>& at,
                        LoopAccuracy& accuracy);

// The probability that a loop that matches a true one has a higher confidence than a false one, ties being
// half. This is the area under the ROC curve. Loops without a confidence (NaN) take no part, and neither do
// loops that are neither right nor wrong (short, joined, parted, step, unsampled). There is no value where
// either kind is missing.
std::optional<double> area_under_roc(std::span<const LoopMatch> loops, std::span<const double> confidence);

}  // namespace lacuna::matching
