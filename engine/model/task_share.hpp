// SPDX-License-Identifier: Apache-2.0
// How several processes share a run, and things that have weights, such as tiles with their points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace lacuna {

// What is planned for all tasks.
struct TaskPlan {
  std::size_t tasks = 1;          // of each step that is shared
  std::size_t levels = 0;         // whose steps are shared, from the first level on
  std::uint64_t tile_points = 0;  // of each task's tiles, at most
  bool reads = false;             // whether reading the scan is shared

  std::size_t tasks_of_level(std::size_t level) const {
    return level < levels && (level > 0 || reads) ? tasks : 1;
  }
};

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
