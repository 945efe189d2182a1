// SPDX-License-Identifier: Apache-2.0
// The arithmetic encoder (Said, section 2.3 and appendix: 32 bits, renormalised by whole bytes).
#pragma once

#include "io/read/laz/symbol_model.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacuna::io::laz {

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
