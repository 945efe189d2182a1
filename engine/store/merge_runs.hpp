// SPDX-License-Identifier: Apache-2.0
// Sorts records that are nearly sorted.
#pragma once

#include <algorithm>
#include <vector>

namespace lacuna {

// Sorts records that come in a few sorted runs, keeping the order of equal ones. Cost: linear, times the
// runs.
template <class Record, class Before>
void merge_runs(std::vector<Record>& records, Before&& before) {
  for (auto end = records.begin(); end != records.end();) {
    const auto next = std::is_sorted_until(end, records.end(), before);
    std::inplace_merge(records.begin(), end, next, before);
    end = next;
  }
}

}  // namespace lacuna
