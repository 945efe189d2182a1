// SPDX-License-Identifier: Apache-2.0
#include "engine/model/task_share.hpp"

#include <algorithm>
#include <numeric>

namespace lacuna {

// A thing belongs to the task that its middle lies in.
IndexRange share_of(std::span<const std::uint64_t> weights, const TaskShare& share) {
  const double all = static_cast<double>(std::accumulate(weights.begin(), weights.end(), std::uint64_t{0}));
  double before = 0;
  IndexRange range;
  for (const std::uint64_t weight : weights) {
    const double middle = before + static_cast<double>(weight) / 2;
    before += static_cast<double>(weight);
    const double place = all > 0 ? middle / all * static_cast<double>(share.tasks) : 0;
    const std::size_t task = std::min(static_cast<std::size_t>(place), share.tasks - 1);
    range.first += task < share.task;
    range.last += task <= share.task;
  }
  return range;
}

}  // namespace lacuna
