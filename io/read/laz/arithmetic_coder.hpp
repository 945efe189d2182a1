// SPDX-License-Identifier: Apache-2.0
// The arithmetic coder and its adaptive models (Said, sections 2.2 and 2.3, and appendix; LAZ, "Entropy
// coding").
//
// Idea: each symbol takes its share of an interval, which narrows from symbol to symbol. The bytes are a
// number within the last interval. A decoder finds the share in which the number lies, and narrows its
// interval likewise. The shares follow the counts of the symbols so far. Cost: two products for each symbol,
// and for a decoder a search among the shares.
#pragma once

#include "io/read/laz/laz.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacuna::io::laz {

// How often each symbol of an alphabet occurred, and its share of the coder's interval. The shares are
// computed anew after more and more symbols, so that few steps pay for it.
template <unsigned kCapacity>
class SymbolModel {
 public:
  static constexpr unsigned kShareBits = 15;  // a share is a number of 2^-15
  static constexpr bool kHasTable = kCapacity > 16;

  // At first all symbols are equally frequent. `symbols` is 2 to kCapacity.
  explicit SymbolModel(unsigned symbols = kCapacity) : symbols_(symbols) {
    std::fill_n(counts_.begin(), symbols, std::uint16_t{1});
    if constexpr (kHasTable) {
      unsigned bits = 3;
      while (symbols > 1u << (bits + 2)) ++bits;
      table_shift_ = kShareBits - bits;
    }
    cycle_ = symbols;
    update();
    cycle_ = until_update_ = (symbols + 6) / 2;
  }

  unsigned symbols() const { return symbols_; }

  // Returns the sum of the shares of all symbols before `symbol`.
  std::uint32_t start(unsigned symbol) const { return starts_[symbol]; }

  // A place in the interval belongs to a symbol from `low` to `high`. The table has both.
  struct Bracket {
    unsigned low, high;
  };
  Bracket bracket(std::uint32_t place) const {
    const std::uint32_t slot = place >> table_shift_;
    return {table_[slot], table_[slot + 1]};
  }

  void count(unsigned symbol) {
    ++counts_[symbol];
    if (--until_update_ == 0) update();
  }

 private:
  static constexpr std::uint32_t kMaxTotal = 1u << kShareBits;
  static constexpr unsigned table_slots() {
    unsigned slots = 8;
    while (kCapacity > slots * 4) slots *= 2;
    return slots;
  }

  void update() {
    total_ += cycle_;
    if (total_ > kMaxTotal) {
      total_ = 0;
      for (unsigned s = 0; s < symbols_; ++s) {
        counts_[s] = static_cast<std::uint16_t>((counts_[s] + 1) / 2);
        total_ += counts_[s];
      }
    }
    const std::uint32_t scale = 0x80000000u / total_;
    std::uint32_t sum = 0;
    unsigned slot = 0;
    for (unsigned s = 0; s < symbols_; ++s) {
      starts_[s] = static_cast<std::uint16_t>((scale * sum) >> (31 - kShareBits));
      sum += counts_[s];
      if constexpr (kHasTable) {
        const unsigned reached = starts_[s] >> table_shift_;
        while (slot < reached) table_[++slot] = static_cast<std::uint16_t>(s - 1);
      }
    }
    if constexpr (kHasTable) {
      // Two slots more than the interval has: rounding in the decoder can place a symbol just behind its end.
      const unsigned slots = (1u << (kShareBits - table_shift_)) + 1;
      while (slot < slots) table_[++slot] = static_cast<std::uint16_t>(symbols_ - 1);
      table_[0] = 0;
    }
    cycle_ = std::min(5 * cycle_ / 4, (symbols_ + 6) * 8);
    until_update_ = cycle_;
  }

  std::array<std::uint16_t, kCapacity> starts_{};
  std::array<std::uint16_t, kCapacity> counts_{};
  std::array<std::uint16_t, kHasTable ? table_slots() + 2 : 1> table_{};
  std::uint32_t symbols_;
  std::uint32_t table_shift_ = 0;
  std::uint32_t total_ = 0;
  std::uint32_t cycle_ = 0;
  std::uint32_t until_update_ = 0;
};

// A model for an alphabet of two symbols.
class BitModel {
 public:
  static constexpr unsigned kShareBits = 13;

  // The share of bit 0, a number of 2^-13.
  std::uint32_t share_of_zero() const { return share_; }

  void count(bool bit) {
    if (!bit) ++zeros_;
    if (--until_update_ == 0) update();
  }

 private:
  void update() {
    total_ += cycle_;
    if (total_ > 1u << kShareBits) {
      total_ = (total_ + 1) / 2;
      zeros_ = (zeros_ + 1) / 2;
      if (zeros_ == total_) ++total_;
    }
    const std::uint32_t scale = 0x80000000u / total_;
    share_ = (zeros_ * scale) >> (31 - kShareBits);
    cycle_ = std::min(5 * cycle_ / 4, 64u);
    until_update_ = cycle_;
  }

  std::uint32_t share_ = 1u << (kShareBits - 1);
  std::uint32_t zeros_ = 1;
  std::uint32_t total_ = 2;
  std::uint32_t cycle_ = 4;
  std::uint32_t until_update_ = 4;
};

// The arithmetic decoder (Said, section 2.3 and appendix: 32 bits, renormalised by whole bytes).

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

// The arithmetic encoder (Said, section 2.3 and appendix: 32 bits, renormalised by whole bytes).

// Collects the bytes from which an ArithmeticDecoder of the same models gets the same symbols. Between calls
// length_ >= kMinLength holds.
class ArithmeticEncoder {
 public:
  // The calls that an ArithmeticDecoder has, too: here they read the value.
  static constexpr bool kEncodes = true;
  template <unsigned kCapacity, class Value>
  void code(SymbolModel<kCapacity>& model, const Value& value) {
    symbol(model, value);
  }

  template <unsigned kCapacity>
  void symbol(SymbolModel<kCapacity>& model, unsigned symbol) {
    const std::uint32_t unit = length_ >> SymbolModel<kCapacity>::kShareBits;
    const std::uint32_t start = model.start(symbol) * unit;
    const std::uint32_t end = symbol + 1 < model.symbols() ? model.start(symbol + 1) * unit : length_;
    narrow(start, end - start);
    model.count(symbol);
  }

  void bit(BitModel& model, bool bit) {
    const std::uint32_t zero = model.share_of_zero() * (length_ >> BitModel::kShareBits);
    if (bit) {
      narrow(zero, length_ - zero);
    } else {
      narrow(0, zero);
    }
    model.count(bit);
  }

  // Encodes the `count` low bits without a model, 1 to 32; all other bits are 0.
  void bits(std::uint32_t bits, unsigned count) {
    if (count <= 19) return few_bits(bits, count);
    few_bits(bits & 0xffff, 16);
    few_bits(bits >> 16, count - 16);
  }

  // Returns all bytes. Nothing can be encoded afterwards.
  std::vector<std::byte> finish();

 private:
  static constexpr std::uint32_t kMinLength = 1u << 24;

  void few_bits(std::uint32_t bits, unsigned count) {
    const std::uint32_t unit = length_ >> count;
    narrow(bits * unit, unit);
  }

  // Goes on with this part of the interval.
  void narrow(std::uint32_t start, std::uint32_t length) {
    base_ += start;
    length_ = length;
    if (base_ < start) [[unlikely]]
      carry();
    while (length_ < kMinLength) {
      bytes_.push_back(static_cast<std::byte>(base_ >> 24));
      base_ <<= 8;
      length_ <<= 8;
    }
  }

  void carry();

  std::vector<std::byte> bytes_;
  std::uint32_t base_ = 0;
  std::uint32_t length_ = 0xffffffff;
};

}  // namespace lacuna::io::laz
