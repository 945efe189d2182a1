// SPDX-License-Identifier: Apache-2.0
// Which loops of two results of one place are of the same hole, such as before and after a scan was
// completed.
#pragma once

#include "engine/model/loop.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace lacuna::matching {

struct ComparedLoop {
  LoopMeasures measures;
  std::vector<Eigen::Vector3d> points;
};

enum class Change {
  kSame,     // it matches, and its area has changed by a tenth or less
  kChanged,  // it matches with another area, or runs along a part of a loop of the other result
  kClosed,   // of the first result alone
  kNew,      // of the second result alone
};
std::string_view name_of(Change change);

// Places in the two results; at least one is there.
struct LoopChange {
  Change change = Change::kSame;
  std::optional<std::size_t> before, after;
};

// Each loop of both results is in at least one change. Changes with an `after` come first, in its order, then
// the closed ones. `tolerance` is the length up to which two curves of one hole may be apart. `match_loops`
// has the rule of a match. Loops of a hole that was parted, or of holes that were joined, are changed.
std::vector<LoopChange> compare_loops(std::span<const ComparedLoop> before,
                                      std::span<const ComparedLoop> after, double tolerance);

}  // namespace lacuna::matching
