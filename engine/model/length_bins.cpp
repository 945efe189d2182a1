// SPDX-License-Identifier: Apache-2.0
#include "engine/model/length_bins.hpp"

#include <bit>
#include <limits>

namespace lacuna {

std::uint32_t LengthBins::bin_of(double length) {
  return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(length) >> kShift);
}

double LengthBins::start_of(std::uint32_t bin) {
  return std::bit_cast<double>(std::uint64_t{bin} << kShift);
}

double LengthBins::median() const {
  std::uint64_t all = 0, before = 0;
  for (const auto& [bin, count] : counts) all += count;
  for (const auto& [bin, count] : counts) {
    if (2 * (before + count) >= all) {
      const double part =
          (static_cast<double>(all) / 2 - static_cast<double>(before)) / static_cast<double>(count);
      return start_of(bin) + part * (start_of(bin + 1) - start_of(bin));
    }
    before += count;
  }
  return 0;
}

double LengthBins::start_of_far() const {
  constexpr std::uint32_t kFactorOf4 = 2 * 64;
  constexpr std::uint64_t kFew = 100;
  std::uint64_t all = 0, upto = 0, within = 0;  // within: the factor of 4 that ends at a bin
  for (const auto& [bin, count] : counts) all += count;
  auto start = counts.begin();
  for (const auto& [bin, count] : counts) {
    for (; start->first + kFactorOf4 < bin; ++start) within -= start->second;
    if (2 * (upto - within) >= all && within * kFew < all) return start_of(bin);
    upto += count;
    within += count;
  }
  return std::numeric_limits<double>::infinity();
}

double LengthBins::sum_of_squares(double end) const {
  double sum = 0;
  for (const auto& [bin, count] : counts)
    if (start_of(bin) < end) sum += static_cast<double>(count) * start_of(bin) * start_of(bin + 1);
  return sum;
}

}  // namespace lacuna
