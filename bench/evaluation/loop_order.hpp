// SPDX-License-Identifier: Apache-2.0
// Whether the points of a loop come in their order along a curve.
#pragma once

#include "bench/evaluation/evaluation.hpp"

namespace lacuna::evaluation {

// Throws `Error` at the first loop of 16 points or more whose points are in no order. Half of its edges are
// longer than 10 spacings of the scan, and than 8 times the median distance to the nearest other point. That
// ratio is 1 to 2 in a loop along a curve. Through random points, it is the root of their number. To match
// such loops takes hours, because their edges are near everything. Cost: n log n.
void check_order(const Result& result, const Truth& truth);

}  // namespace lacuna::evaluation
