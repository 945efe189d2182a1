// SPDX-License-Identifier: Apache-2.0
// A seeded random order of 0 .. size-1 without a table: the k-th index in a few operations.
#pragma once

#include "bench/synth/random.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace lacuna::synth {

// A Feistel network over the smallest power of two that holds `size`. Its halves differ by a bit if
// necessary. The network maps a value outside the range again, on average less than once (cycle walking:
// Black and Rogaway 2002). It is a bijection by construction.
class Permutation {
 public:
  Permutation(std::uint64_t size, std::uint64_t seed)
      : size_(size),
        low_bits_(static_cast<unsigned>(std::bit_width(size < 2 ? 1 : size - 1) + 1) / 2),
        low_mask_((std::uint64_t{1} << low_bits_) - 1),
        high_mask_((std::uint64_t{1} << (std::bit_width(size < 2 ? 1 : size - 1) - low_bits_)) - 1) {
    const Random random(seed, 0x0bde);
    for (std::size_t round = 0; round < keys_.size(); ++round) keys_[round] = random.bits(round);
  }

  // `index` < size.
  std::uint64_t operator()(std::uint64_t index) const {
    do index = shuffle(index);
    while (index >= size_);
    return index;
  }

 private:
  std::uint64_t shuffle(std::uint64_t value) const {
    std::uint64_t low = value & low_mask_;
    std::uint64_t high = value >> low_bits_;
    for (std::size_t round = 0; round < keys_.size(); round += 2) {
      high ^= mix(low ^ keys_[round]) & high_mask_;
      low ^= mix(high ^ keys_[round + 1]) & low_mask_;
    }
    return (high << low_bits_) | low;
  }

  std::uint64_t size_;
  unsigned low_bits_;
  std::uint64_t low_mask_, high_mask_;
  std::array<std::uint64_t, 6> keys_{};
};

// The order in which points are written.
enum class Order { kScanline, kRandom };

}  // namespace lacuna::synth
