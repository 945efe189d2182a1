// Which true loops were found, and which loops are false.
#pragma once

#include "tools/accuracy/true_loops.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace lacuna::accuracy {

// A loop lies on a true loop if `share` of its points are within the tolerance of an edge of that, and covers
// it if `share` of its vertices are within the tolerance of an edge of the loop. It matches if both hold.
struct MatchRule {
  double tolerance = 0;  // a length
  double share = 0.7;
  std::size_t min_vertices = 8;  // true loops with fewer do not count
};

enum class EdgeDecision {
  kFound,     // the first loop that matches its true loop
  kRepeated,  // a later one
  kShort,     // matches only a true loop that does not count: neither right nor wrong
  kFalse,     // matches none
};

struct LoopMatch {
  EdgeDecision verdict = EdgeDecision::kFalse;
  // Of the true loops that it matches the best one: counting before short, then by the smaller share, then by
  // both, then the first; of a false loop the best of all that it comes near to. None: it is near none.
  std::optional<std::size_t> true_loop;
  double on = 0;       // share of its points on that true loop
  double covered = 0;  // share of that true loop's vertices on it
};

struct TrueMatch {
  bool counts = true;
  std::optional<std::size_t> found_by;  // the first loop that matches; none: missed
};

struct LoopScores {
  std::size_t true_loops = 0, found = 0, missed = 0;  // of those that count
  std::size_t short_loops = 0;                        // true ones that do not
  std::size_t loops = 0, false_loops = 0, repeated = 0;
  std::optional<double> recall;     // found of the true ones; none: there are none
  std::optional<double> precision;  // 1 - false of the loops; none: there are none
};

struct LoopAccuracy {
  std::vector<LoopMatch> loops;       // in the order given
  std::vector<TrueMatch> true_loops;  // in the order given
  LoopScores scores;
};

// Ids are places in `positions`. Loops that are all near one another cost the product of their numbers; else
// n log n.
LoopAccuracy match_loops(std::span<const LoopIds> loops, std::span<const TrueLoop> truth,
                         std::span<const Eigen::Vector3d> positions, const MatchRule& rule);

// The probability that a loop that matches a true one has a higher confidence than a false one, ties being
// half: the area under the ROC curve. Loops without a confidence (NaN) or on short true loops take no part;
// none where either kind is missing.
std::optional<double> area_under_roc(std::span<const LoopMatch> loops, std::span<const double> confidence);

}  // namespace lacuna::accuracy
