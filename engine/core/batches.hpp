// What is computed for eight points at once, for any number of points.
#pragma once

#include "engine/core/eight.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lacuna {

// visit(first) for first = 0, 8, 16, ... below `count`, while `batch` holds item(i) for the eight i from
// `first` on, or those left.
template <class Item, class MakeItem, class Visit>
void for_each_batch(std::size_t count, std::vector<Item>& batch, MakeItem&& item, Visit&& visit) {
  for (std::size_t first = 0; first < count; first += kEight) {
    batch.clear();
    for (std::size_t i = first; i < std::min(first + kEight, count); ++i) batch.push_back(item(i));
    visit(first);
  }
}

}  // namespace lacuna
