// SPDX-License-Identifier: Apache-2.0
// The scores of `lacuna-bench score`: of one cloud, and of many.
#pragma once

#include "bench/evaluation/evaluation.hpp"
#include "bench/evaluation/hole_areas.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lacuna::evaluation {

struct CloudScore {
  Tally holes, outer_curves;    // that count
  std::size_t false_loops = 0;  // with those that match a true loop which another loop has found
  std::size_t repeated = 0;     // these alone
  std::size_t joined_or_parted = 0;
  HoleAreas areas;       // squares of the spacing
  PointAccuracy points;  // the boundary points where the result has them, else the points of the loops
};

// Loops along steps of density are neither right nor wrong: they have no area and
// no points. Points of true loops that do not count are right if they are flagged, and not missed otherwise.
// Throws `Error` as evaluate() does.
CloudScore score_cloud(const Result& result, const Truth& truth, const EvaluationRule& rule);

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
