// SPDX-License-Identifier: Apache-2.0
// Random numbers without state: each is a hash of (seed, stream, index). So any point can be computed on its
// own, in any order, on any machine. The functions use only integer operations and exact conversions.
#pragma once

#include <cstdint>

namespace lacuna::synth {

// The finalizer of SplitMix64 (Steele, Lea, Flood 2014): a bijection of 64 bits.
constexpr std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

// Each pair (seed, stream) has an independent sequence.
class Random {
 public:
  constexpr Random(std::uint64_t seed, std::uint64_t stream) : key_(mix(mix(seed + kGolden) + stream)) {}

  constexpr std::uint64_t bits(std::uint64_t index) const { return mix(key_ + (index + 1) * kGolden); }

  // Returns a multiple of 2^-53 in [0, 1).
  constexpr double uniform(std::uint64_t index) const {
    return static_cast<double>(bits(index) >> 11) * 0x1p-53;
  }

  // Returns a number in [low, high).
  constexpr double uniform(std::uint64_t index, double low, double high) const {
    return low + (high - low) * uniform(index);
  }

  // Returns a number with mean 0 and variance 1, within +-6. It is the sum of twelve uniforms of 16 bits
  // (Irwin-Hall), an exact integer.
  constexpr double normal(std::uint64_t index) const {
    std::int64_t sum = 0;
    for (std::uint64_t part = 0; part < 3; ++part) {
      const std::uint64_t word = bits(3 * index + part);
      for (int shift = 0; shift < 64; shift += 16) sum += static_cast<std::int64_t>((word >> shift) & 0xffff);
    }
    return static_cast<double>(2 * sum - 12 * 65535) * 0x1p-17;
  }

 private:
  static constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15u;  // 2^64 / golden ratio
  std::uint64_t key_;
};

}  // namespace lacuna::synth
