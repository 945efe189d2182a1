// Sorting rows of numbers column by column, without a branch: the same comparisons whatever the numbers.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lacuna {

// The smaller number goes to row `low`, the larger to row `high`.
struct Comparison {
  std::uint8_t low, high;
};

inline constexpr std::size_t kMostSortedRows = 128;

// The comparisons after which the first `wanted` of `rows` rows are the smallest, in ascending order:
// Batcher's odd-even merge exchange (Knuth, The Art of Computer Programming 3, 5.2.2, algorithm M), without
// those that the wanted rows do not depend on; at most kMostSortedRows. Computed once for each pair, then
// kept.
struct SortingNetwork {
  const Comparison* comparisons;
  std::size_t count;
};
SortingNetwork sorting_network(std::size_t rows, std::size_t wanted);

}  // namespace lacuna
