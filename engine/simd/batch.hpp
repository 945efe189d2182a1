// SPDX-License-Identifier: Apache-2.0
// Numbers of several points side by side. Kernels read and write them, whatever the width of their vectors.
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

// Calls visit(first) for first = 0, 8, 16, ... below `count`. Meanwhile `batch` holds item(i) for the eight i
// from `first` on, or for those left.
template <class Item, class MakeItem, class Visit>
void for_each_batch(std::size_t count, std::vector<Item>& batch, MakeItem&& item, Visit&& visit) {
  for (std::size_t first = 0; first < count; first += kBatchSize) {
    batch.clear();
    for (std::size_t i = first; i < std::min(first + kBatchSize, count); ++i) batch.push_back(item(i));
    visit(first);
  }
}

}  // namespace lacuna
