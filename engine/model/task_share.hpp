// SPDX-License-Identifier: Apache-2.0
// How several tasks share things that have weights, such as tiles with their points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace lacuna {

// One of several tasks.
struct TaskShare {
  std::size_t task = 0, tasks = 1;
};

struct IndexRange {
  std::size_t first = 0, last = 0;  // [first, last)
};

// Returns the things of a task. Tasks have runs of about equal weights.
IndexRange share_of(std::span<const std::uint64_t> weights, const TaskShare& share);

}  // namespace lacuna
