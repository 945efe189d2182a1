// SPDX-License-Identifier: Apache-2.0
// The bytes of one field of an E57 scan, as its packets bring them, and the values that they hold.
//
// Values follow each other bit by bit, from the lowest bit of a byte on, without regard to bytes or packets.
// An integer is stored less its minimum, in as many bits as its maximum needs. ASTM E2807-11, bitPackCodec.
#pragma once

#include "io/e57/e57_header.hpp"
#include "io/rows/scalar.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lacuna::io {

class FieldStream {
 public:
  explicit FieldStream(E57Field field) : field_(std::move(field)) {}

  // Returns the number of values that can be taken, at most `most`.
  std::size_t ready(std::size_t most) const;
  // Whether more bits are held than padding explains. libE57Format pads integers to words of
  // 8 to 64 bits, other programs to bytes.
  bool holds_more() const { return held_bits() >= std::max(8U, std::bit_ceil(field_.bits)); }
  std::size_t held_bytes() const { return static_cast<std::size_t>(held_bits() / 8); }

  // Adds bytes behind the bytes held. Cost: linear, whatever is held.
  void append(std::span<const std::byte> bytes);
  // Takes the next `count` values, which must be ready. `to` has a type that holds them; integers of more
  // than 32 bits and scaled integers become doubles. `added` is added to integers.
  void take(std::size_t count, Column to, std::int64_t added = 0);

 private:
  std::uint64_t held_bits() const { return end_ * std::uint64_t{8} - begin_bit_; }

  E57Field field_;
  std::vector<std::byte> bytes_;  // with padding, so that a value can be loaded as whole words
  std::size_t end_ = 0;           // of the bytes held
  std::uint64_t begin_bit_ = 0;   // of the next value
};

}  // namespace lacuna::io
