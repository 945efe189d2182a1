// SPDX-License-Identifier: Apache-2.0
// Integers coded as their difference to a prediction (LAZ, "Integer compressor").
#pragma once

#include "io/read/laz/arithmetic_decoder.hpp"
#include "io/read/laz/arithmetic_encoder.hpp"

#include <array>
#include <bit>
#include <cstdint>

namespace lacuna::io::laz {

// Decodes or encodes integers of kBits bits, in kContexts contexts. The difference to the prediction is coded
// as a number k, in one model for each context. Then comes its place in the k-th interval. That is 0 and 1
// for k = 0, else -(2^k - 1) ... -2^(k-1) and 2^(k-1) + 1 ... 2^k. The highest 8 bits of the place have a
// model for each k, the lower ones none.
template <unsigned kBits, unsigned kContexts = 1>
class IntegerCoder {
 public:
  using KModel = SymbolModel<kBits + 1>;

  IntegerCoder() {
    for (unsigned k = 1; k < kHighBits; ++k)
      short_places_[k - 1] = SymbolModel<1u << (kHighBits - 1)>(1u << k);
  }

  // The value modulo 2^kBits; in 32 bits of two's complement where kBits is 32.
  std::uint32_t decode(ArithmeticDecoder& decoder, std::uint32_t prediction, unsigned context = 0) {
    return (prediction + difference(decoder, ks_[context])) & kMask;
  }

  // Encodes the value that decode() with the same prediction returns.
  void encode(ArithmeticEncoder& encoder, std::uint32_t prediction, std::uint32_t value,
              unsigned context = 0) {
    encode(encoder, prediction, value, ks_[context]);
  }
  void encode(ArithmeticEncoder& encoder, std::uint32_t prediction, std::uint32_t value, KModel& ks) {
    // The difference as a signed number of kBits bits, widened to 32.
    constexpr unsigned kUnused = 32 - kBits;
    put_difference(encoder, static_cast<std::int32_t>((value - prediction) << kUnused) >> kUnused, ks);
  }

  // Decodes the value, or encodes it.
  template <class Value>
  void code(ArithmeticDecoder& decoder, Value prediction, Value& value, unsigned context = 0) {
    value = static_cast<Value>(decode(decoder, static_cast<std::uint32_t>(prediction), context));
  }
  template <class Value>
  void code(ArithmeticEncoder& encoder, Value prediction, const Value& value, unsigned context = 0) {
    encode(encoder, static_cast<std::uint32_t>(prediction), static_cast<std::uint32_t>(value), context);
  }

  // The k of the last value, a measure of how far off its prediction was: the context of other values.
  unsigned k() const { return k_; }

 private:
  static constexpr unsigned kHighBits = 8;
  static constexpr std::uint32_t kMask = kBits == 32 ? 0xffffffffu : (1u << kBits % 32) - 1;

  std::uint32_t difference(ArithmeticDecoder& decoder, KModel& ks) {
    k_ = decoder.symbol(ks);
    if (k_ == 0) return decoder.bit(zero_or_one_);
    if (k_ == 32) return 0x80000000u;  // the only difference of 32 bits that no smaller k has
    std::uint32_t place;
    if (k_ < kHighBits) {
      place = decoder.symbol(short_places_[k_ - 1]);
    } else {
      place = decoder.symbol(places_[k_ - kHighBits]);
      if (k_ > kHighBits) {
        const unsigned low_bits = k_ - kHighBits;
        place = place << low_bits | decoder.bits(low_bits);
      }
    }
    return place >= 1u << (k_ - 1) ? place + 1 : place - ((1u << k_) - 1);
  }

  void put_difference(ArithmeticEncoder& encoder, std::int32_t difference, KModel& ks) {
    const auto bits = static_cast<std::uint32_t>(difference);
    k_ = static_cast<unsigned>(std::bit_width(difference <= 0 ? 0u - bits : bits - 1));
    encoder.symbol(ks, k_);
    if (k_ == 0) return encoder.bit(zero_or_one_, difference == 1);
    if (k_ == 32) return;
    const std::uint32_t place = difference < 0 ? bits + ((1u << k_) - 1) : bits - 1;
    if (k_ < kHighBits) return encoder.symbol(short_places_[k_ - 1], place);
    const unsigned low_bits = k_ - kHighBits;
    encoder.symbol(places_[k_ - kHighBits], place >> low_bits);
    if (low_bits > 0) encoder.bits(place & ((1u << low_bits) - 1), low_bits);
  }

  std::array<KModel, kContexts> ks_;
  BitModel zero_or_one_;
  std::array<SymbolModel<1u << (kHighBits - 1)>, kHighBits - 1> short_places_;
  std::array<SymbolModel<1u << kHighBits>, kBits - kHighBits + 1> places_;
  unsigned k_ = 0;
};

}  // namespace lacuna::io::laz
