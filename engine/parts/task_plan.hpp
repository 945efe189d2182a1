// SPDX-License-Identifier: Apache-2.0
// How several processes share a run.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lacuna {

struct TaskPlan {
  std::size_t tasks = 1;          // of each step that is shared
  std::size_t levels = 0;         // whose steps are shared, from the first level on
  std::uint64_t tile_points = 0;  // of each task's tiles, at most
  bool reads = false;             // whether reading the scan is shared

  std::size_t tasks_of_level(std::size_t level) const {
    return level < levels && (level > 0 || reads) ? tasks : 1;
  }
};

}  // namespace lacuna
