// SPDX-License-Identifier: Apache-2.0
// arithmetic: vectors, angles, random numbers and random orders with the same bits on every machine.
//
// Idea: doubles are added in the order written, and sine and cosine come from + - * and floor only. A random
// number has no state: it is a hash of (seed, stream, index). So any point can be computed on its own, in any
// order.
//
// Source: SplitMix64 (Steele, Lea, Flood 2014); cycle walking (Black and Rogaway 2002). Cost: a few
// operations.
#pragma once

#include "engine/model/mixed.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace lacuna::synth {

struct Vec3 {
  double x = 0, y = 0, z = 0;
};

constexpr Vec3 operator+(Vec3 a, Vec3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec3 operator-(Vec3 a, Vec3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec3 operator*(double s, Vec3 a) {
  return {s * a.x, s * a.y, s * a.z};
}
constexpr double dot(Vec3 a, Vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double distance(Vec3 a, Vec3 b) {
  return std::sqrt(dot(b - a, b - a));
}
inline Vec3 normalized(Vec3 a) {
  return (1 / std::sqrt(dot(a, a))) * a;
}

inline constexpr double kTwoPi = 6.283185307179586;

struct SinCos {
  double sin, cos;
};

// Sine and cosine of an angle in turns, below 2^50. Uses Taylor series within an eighth of a turn of the
// nearest quarter: error below 4e-16.
inline SinCos sin_cos(double turns) {
  const double quarter = std::floor(4 * turns + 0.5);
  const double x = kTwoPi * (turns - 0.25 * quarter);
  const double y = x * x;
  double s = -1.0 / 1307674368000;  // 1/15!
  double c = 1.0 / 20922789888000;  // 1/16!
  for (const double term :
       {1.0 / 6227020800, -1.0 / 39916800, 1.0 / 362880, -1.0 / 5040, 1.0 / 120, -1.0 / 6})
    s = s * y + term;
  for (const double term :
       {-1.0 / 87178291200, 1.0 / 479001600, -1.0 / 3628800, 1.0 / 40320, -1.0 / 720, 1.0 / 24, -1.0 / 2})
    c = c * y + term;
  const double sine = x + x * (y * s);
  const double cosine = 1 + y * c;
  switch (static_cast<long long>(quarter) & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

inline constexpr std::uint64_t kMixStep = 0x9e3779b97f4a7c15;  // the step of SplitMix64

// A bijection of 64 bits: mixed() without its step.
constexpr std::uint64_t mix(std::uint64_t bits) {
  return mixed(bits - kMixStep);
}

// Each pair (seed, stream) has an independent sequence.
class Random {
 public:
  constexpr Random(std::uint64_t seed, std::uint64_t stream) : key_(mix(mixed(seed) + stream)) {}

  constexpr std::uint64_t bits(std::uint64_t index) const { return mixed(key_ + index * kMixStep); }

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
  std::uint64_t key_;
};

// A random order of 0 .. size-1 without a table: a Feistel network over the smallest power of two that holds
// `size`. Its halves differ by a bit if necessary. The network maps a value outside the range again, on
// average less than once. It is a bijection by construction.
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
