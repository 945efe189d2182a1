// Sorting rows of numbers column by column, without a branch: the same comparisons whatever the numbers.
#pragma once

#include "engine/core/dispatch.hpp"
#include "engine/core/eight.hpp"

#include <cstddef>
#include <cstdint>

namespace lacuna {

// The smaller number goes to row `low`, the larger to row `high`.
struct Comparison {
  std::uint8_t low, high;
};

// visit(comparison): those after which `rows` rows are in ascending order. Batcher's odd-even merge exchange
// (Knuth, The Art of Computer Programming 3, 5.2.2, algorithm M).
template <class Visit>
constexpr void for_each_comparison(std::size_t rows, Visit&& visit) {
  std::size_t top = 1;  // half of the rows, rounded up to a power of two
  while (2 * top < rows) top *= 2;
  for (std::size_t p = top; p > 0; p /= 2) {
    std::size_t q = top, r = 0, d = p;
    for (;;) {
      for (std::size_t i = 0; i + d < rows; ++i) {
        if ((i & p) == r) visit(Comparison{static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i + d)});
      }
      if (q == p) break;
      d = q - p;
      q /= 2;
      r = p;
    }
  }
}

inline constexpr std::size_t kMostSortedRows = 128;
inline constexpr std::size_t kRowsInRegisters = 32;  // more of them take much longer

// Those comparisons, at most kMostSortedRows rows, that put the `wanted` smallest first. Computed once for
// each pair, then kept.
struct SortingNetwork {
  const Comparison* comparisons;
  std::size_t count;
};
SortingNetwork sorting_network(std::size_t rows, std::size_t wanted);

// Of each column, the `wanted` smallest of the first `count` numbers come first, in ascending order; the
// others in any. Not for NaN. At most kMostSortedRows.
using SortRows = void(Eight* rows, std::size_t count, std::size_t wanted);
LACUNA_DISPATCH(SortRows, sort_rows)
using SortSingleRows = void(Sixteen* rows, std::size_t count, std::size_t wanted);
LACUNA_DISPATCH(SortSingleRows, sort_single_rows)

// For *.lanes.cpp: all rows of as many columns as fit, from `first` on.
using SortColumns = void(EightSingles* rows, std::size_t count, std::size_t first);
LACUNA_DECLARE(SortColumns, sort_columns)

}  // namespace lacuna
