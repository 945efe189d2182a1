// SPDX-License-Identifier: Apache-2.0
// cloud_score: the scores of `lacuna-bench score`, of one cloud and of many: per hole, per area and per
// point.
//
// Idea: the surface of a hole is the triangulation of its loop that has the least area. It is divided into
// pieces so small that the centroid of a piece decides for it. A piece counts as found, or as right, where a
// hole of the other kind is near.
//
// Source: completeness and correctness of the ISPRS benchmark on indoor modelling,
// https://www.isprs.org/resources/datasets/benchmarks/IndoorModeling/results.aspx.
// Cost: n log n for points and pieces. Memory: the pieces of the true holes.
#pragma once

#include "bench/evaluation/evaluation.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace lacuna::evaluation {

// In squares of the unit of the scan.
struct HoleAreas {
  double truth = 0, covered = 0;  // of the true holes that count, and the part of it near found holes
  double found = 0, right = 0;    // of the found holes, and the part of it near true holes, counting or not
};

// Completeness is covered / truth, and correctness right / found. Outer curves have no surface, and neither
// has a loop with a point that is not finite. Loops along steps of density take no part. A loop that repeats
// another has no right place. Places of a hole are near others within the mean tolerance of the hole's
// points. Pieces have edges of at most half of that tolerance. With a tolerance of 0, all areas are 0.
HoleAreas compare_areas(std::span<const LoopIds> loops, const Truth& truth, const LoopAccuracy& accuracy,
                        const MatchRule& rule);

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

}  // namespace lacuna::evaluation
