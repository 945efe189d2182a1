// SPDX-License-Identifier: Apache-2.0
// The arithmetic decoder (Said, section 2.3 and appendix: 32 bits, renormalised by whole bytes).
#pragma once

#include "io/read/laz/laz.hpp"
#include "io/read/laz/symbol_model.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacuna::io::laz {

// Returns all bytes of a chunk from `begin` to `end`. Throws `Corrupt` if the chunk is shorter.
std::vector<std::byte> read_all(const ChunkBytes& bytes, std::uint64_t begin, std::uint64_t end);

// Decodes the bytes of a chunk from `begin` to `end`, which are within it; the chunk outlives the decoder. An
// encoder ends its data such that a decoder reads exactly all bytes; so each function throws `Corrupt` at the
// end of the bytes. Between calls value_ < length_ and length_ >= kMinLength hold, whatever the bytes are.
class ArithmeticDecoder {
 public:
  ArithmeticDecoder(const ChunkBytes& bytes, std::uint64_t begin, std::uint64_t end)
      : bytes_(&bytes), left_at_(begin), left_end_(end) {
    for (int i = 0; i < 4; ++i) value_ = value_ << 8 | next_byte();
    if (value_ == length_) throw Corrupt("the compressed points begin with bytes that no encoder writes");
  }

  // Whether the bytes end here as ArithmeticEncoder::finish() ends them. It rounds a place in the interval
  // up, to whole steps.
  bool is_at_end() const {
    const bool is_long = length_ > 2 * kMinLength;
    const std::uint32_t most = is_long ? kMinLength : kMinLength / 2;
    const std::uint32_t step = is_long ? kMinLength : kMinLength / 256;
    return left_at_ == left_end_ && next_ == end_ && value_ <= most && value_ > most - step;
  }

  // Not to be copied: the bytes may lie in its buffer.
  ArithmeticDecoder(ArithmeticDecoder&&) = default;
  ArithmeticDecoder& operator=(ArithmeticDecoder&&) = default;

  // The calls that an ArithmeticEncoder has, too: here they set the value.
  static constexpr bool kEncodes = false;
  template <unsigned kCapacity, class Value>
  void code(SymbolModel<kCapacity>& model, Value& value) {
    value = static_cast<Value>(symbol(model));
  }

  template <unsigned kCapacity>
  unsigned symbol(SymbolModel<kCapacity>& model) {
    const std::uint32_t unit = length_ >> SymbolModel<kCapacity>::kShareBits;
    unsigned low, high;
    if constexpr (SymbolModel<kCapacity>::kHasTable) {
      const std::uint32_t place = value_ / unit;
      const auto bracket = model.bracket(place);
      low = bracket.low;
      high = bracket.high + 1;
      while (high > low + 1) {
        const unsigned middle = (low + high) / 2;
        (model.start(middle) > place ? high : low) = middle;
      }
    } else {  // few symbols: products are faster than a division
      low = 0;
      high = model.symbols();
      while (high > low + 1) {
        const unsigned middle = (low + high) / 2;
        (model.start(middle) * unit > value_ ? high : low) = middle;
      }
    }
    const std::uint32_t start = model.start(low) * unit;
    length_ = (low + 1 < model.symbols() ? model.start(low + 1) * unit : length_) - start;
    value_ -= start;
    renormalise();
    model.count(low);
    return low;
  }

  bool bit(BitModel& model) {
    const std::uint32_t zero = model.share_of_zero() * (length_ >> BitModel::kShareBits);
    const bool one = value_ >= zero;
    if (one) {
      value_ -= zero;
      length_ -= zero;
    } else {
      length_ = zero;
    }
    renormalise();
    model.count(one);
    return one;
  }

  // `count` bits without a model, 1 to 32.
  std::uint32_t bits(unsigned count) {
    if (count <= 19) return few_bits(count);
    const std::uint32_t low = few_bits(16);
    return few_bits(count - 16) << 16 | low;
  }

 private:
  static constexpr std::uint32_t kMinLength = 1u << 24;

  std::uint32_t few_bits(unsigned count) {
    length_ >>= count;
    const std::uint32_t bits = value_ / length_;
    if (bits >> count) throw Corrupt("the compressed points are damaged");
    value_ -= bits * length_;
    renormalise();
    return bits;
  }

  void renormalise() {
    while (length_ < kMinLength) {
      value_ = value_ << 8 | next_byte();
      length_ <<= 8;
    }
  }

  std::uint32_t next_byte() {
    if (next_ == end_) [[unlikely]]
      read_more();
    return std::to_integer<std::uint32_t>(*next_++);
  }

  void read_more();

  const std::byte* next_ = nullptr;
  const std::byte* end_ = nullptr;
  std::uint32_t value_ = 0;
  std::uint32_t length_ = 0xffffffff;
  const ChunkBytes* bytes_;
  std::uint64_t left_at_, left_end_;  // in the chunk, of the bytes behind `end_`
  std::vector<std::byte> buffer_;
};

}  // namespace lacuna::io::laz
