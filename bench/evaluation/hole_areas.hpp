// SPDX-License-Identifier: Apache-2.0
// How much of the area of the holes is found.
#pragma once

#include "bench/evaluation/evaluation.hpp"

#include <span>

namespace lacuna::evaluation {

// In squares of the unit of the scan.
struct HoleAreas {
  double truth = 0, covered = 0;  // of the true holes that count, and the part of it near found holes
  double found = 0, right = 0;    // of the found holes, and the part of it near true holes, counting or not
};

// Completeness is covered / truth, and correctness right / found: ISPRS benchmark on indoor modelling,
// https://www.isprs.org/resources/datasets/benchmarks/IndoorModeling/results.aspx. The surface of a hole is
// the triangulation of its loop that has the least area. Outer curves have none, and neither has a loop with
// a point that is not finite. Loops along steps of density take no part. A loop
// that repeats another has no right place. Places of a hole are near others within the mean tolerance of the
// hole's points. Each surface is divided into pieces with edges of at most half of its mean tolerance. The
// centroid of a piece decides for the piece. With a tolerance of 0, all areas are 0. Cost: n log n for points
// and pieces. Memory: the pieces of the true holes.
HoleAreas compare_areas(std::span<const LoopIds> loops, const Truth& truth, const LoopAccuracy& accuracy,
                        const MatchRule& rule);

}  // namespace lacuna::evaluation
