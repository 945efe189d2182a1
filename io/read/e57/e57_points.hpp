// SPDX-License-Identifier: Apache-2.0
// The points of one E57 scan, front to back.
//
// Its section begins with 32 bytes: a 1, 7 bytes of zero, the section's length, the offsets of its data and
// of its index. Packets follow. Each begins with its type, flags and its length less 1, in 1, 1 and 2 bytes.
// A data packet, type 1, has the number of fields in 2 bytes, the length of each field's part in 2 bytes, and
// the parts. Packets of an index, type 0, and empty ones, type 2, are passed over. ASTM E2807-11.
#pragma once

#include "io/read/e57/e57_header.hpp"
#include "io/read/e57/paged_file.hpp"
#include "io/read/rows/scalar.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lacuna::io {

// The bytes of one field of a scan, as its packets bring them, and the values that they hold.
//
// Values follow each other bit by bit, from the lowest bit of a byte on, without regard to bytes or packets.
// An integer is stored less its minimum, in as many bits as its maximum needs. ASTM E2807-11, bitPackCodec.
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

// Holds one packet, and at most 8 MiB of values that arrive before the values of other fields.
class E57Points {
 public:
  // `number` is the scan's in the file. Throws `Error` unless the section of its points can be read.
  E57Points(PagedFile& pages, const E57Scan& scan, std::size_t number);

  std::uint64_t left() const { return left_; }

  // Returns how many points can be taken, at least 1 and at most `most`, while points are left. Reads packets
  // for them. Throws `Error` if packets are damaged or end too early.
  std::size_t ready(std::size_t most);
  // Copies the values of a field for the next `count` points, which are ready. Call it once for each field,
  // then `pass`.
  void take(std::size_t field, std::size_t count, Column to, std::int64_t added) {
    streams_[field].take(count, to, added);
  }
  void pass(std::size_t count) { left_ -= count; }
  // Throws `Error` if the packets hold more points than the scan declares, and no point is left to be taken.
  // One point of integers alone may be taken for padding.
  void require_end();

 private:
  void read_packet();
  void read_data(std::uint64_t place, std::size_t bytes);
  bool holds_more() const;
  [[noreturn]] void fail_more() const;
  [[noreturn]] void fail(std::uint64_t place, const std::string& reason) const;

  PagedFile& pages_;
  std::size_t number_;
  std::uint64_t records_;
  std::uint64_t left_;
  std::uint64_t end_ = 0;  // of the section, logical
  std::vector<FieldStream> streams_;
  std::vector<std::byte> packet_;
};

}  // namespace lacuna::io
