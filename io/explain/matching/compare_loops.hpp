// SPDX-License-Identifier: Apache-2.0
// Which loops of two results of one place are of the same hole, such as before and after a scan was
// completed. It says, too, why one result alone has the others.
//
// Idea: curves that run along each other are of one hole. Over a loop without such a curve, the sample of the
// other scan says whether surface has come or gone. Source: Lacuna's own. Cost: a search of the nearest for
// each vertex, and for 64 places of each loop.
#pragma once

#include "engine/model/loop.hpp"

#include <cstddef>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace lacuna::matching {

struct ComparedLoop {
  LoopMeasures measures;
  std::vector<Eigen::Vector3d> points;
  double tolerance = 0;  // of the place: how far from its points other curves of its hole may lie
};

struct ComparedScan {
  std::vector<ComparedLoop> loops;
  std::vector<Eigen::Vector3d> sample;  // even, of the scan
  double spacing = 0;                   // typical distance of neighbours in the sample
};

enum class Change {
  kSame,           // it matches, and its area has changed by a tenth, or by half of the larger spacing along
                   // its perimeter, or by less
  kChanged,        // it matches with another area, was divided or joined, or runs along a part of another
  kClosed,         // of the first result alone: the second scan has surface there
  kNotFoundNow,    // of the first result alone: the second scan is empty there, too
  kOpened,         // of the second result alone: the first scan has surface there
  kFoundNow,       // of the second result alone: the first scan is empty there, too
  kNotComparable,  // the other scan does not reach the loop, or its sample is too coarse for it
};
std::string_view name_of(Change change);

// Places in the two results; at least one is there. Both lists ascend.
struct LoopChange {
  Change change = Change::kSame;
  std::vector<std::size_t> before, after;
};

// Each loop of both results is in one change. Loops of a hole that was divided, or of holes that were joined,
// share one. Changes with loops of the second result come first, in its order. `tolerance` is the length up
// to which two curves of one hole may be apart; a loop's own holds where it is larger. `match_loops` has the
// rule of a match.
//
// The other scan has surface at a loop if half of up to 64 places over it are near the sample. Near is within
// 1.5 of its spacings. For an outer curve these are places beyond it. Places so near to the loop do not
// count. The other scan reaches a loop if half of the loop's points are within twice that distance of its
// sample.
std::vector<LoopChange> compare_loops(const ComparedScan& before, const ComparedScan& after,
                                      double tolerance);

}  // namespace lacuna::matching
