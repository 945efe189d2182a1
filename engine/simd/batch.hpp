// SPDX-License-Identifier: Apache-2.0
// Numbers of several points side by side: what a kernel reads and writes, whatever the width of its vectors.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lacuna {

inline constexpr std::size_t kBatchSize = 8;  // points

// One number of each point.
template <class Number, std::size_t kSize = kBatchSize>
struct alignas(kSize * sizeof(Number)) Batch {
  Number at[kSize];
};

// visit(first) for first = 0, 8, 16, ... below `count`, while `batch` holds item(i) for the eight i from
// `first` on, or those left.
template <class Item, class MakeItem, class Visit>
void for_each_batch(std::size_t count, std::vector<Item>& batch, MakeItem&& item, Visit&& visit) {
  for (std::size_t first = 0; first < count; first += kBatchSize) {
    batch.clear();
    for (std::size_t i = first; i < std::min(first + kBatchSize, count); ++i) batch.push_back(item(i));
    visit(first);
  }
}

}  // namespace lacuna
