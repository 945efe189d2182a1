// SPDX-License-Identifier: Apache-2.0
// A histogram of lengths. It is exact in any order of adding.
#pragma once

#include <cstdint>
#include <map>

namespace lacuna {

// Counts positive numbers in bins. Each power of two has 64 bins. Bins are in the order of the numbers.
struct LengthBins {
  static constexpr int kShift = 46;  // bits of a number within a bin
  std::map<std::uint32_t, std::uint64_t> counts;

  static std::uint32_t bin_of(double length);  // positive
  static double start_of(std::uint32_t bin);   // the shortest of the bin
  // Returns the median, as if the numbers of a bin were spread evenly over it. Returns 0 without any number.
  double median() const;
  // Returns where far numbers begin: beyond the median, and beyond a factor of 4 that holds fewer than one
  // number in a hundred. Infinite where no number is far.
  double start_of_far() const;
  // Returns the sum of the squares of numbers below `end`, within 1.6 %.
  double sum_of_squares(double end) const;
};

// Mean distance of a point to its neighbours over the spacing, on a square grid with k = 15.
inline constexpr double kDistanceOverSpacing = 1.7;

}  // namespace lacuna
