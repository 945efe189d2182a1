// SPDX-License-Identifier: Apache-2.0
// GPS times of GPSTIME11 version 2 and of POINT14 (LAZ, "GPSTIME11" and "POINT14, GPS time layer").
#pragma once

#include "io/read/laz/integer_coder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace lacuna::io::laz {

// The two items code the same way, but only GPSTIME11 codes times that are the last point's: POINT14 knows
// that from another layer.
enum class GpsTimeCodes { kGpsTime11, kPoint14 };

// Bits of double values, predicted as integers from up to four interleaved sequences of times, such as of
// several flight lines. In a sequence a difference is often a multiple of the last one.
template <GpsTimeCodes kCodes>
class GpsTimeCoder {
 public:
  explicit GpsTimeCoder(std::uint64_t first) { times_[0] = first; }

  // Decodes the next time, as the bits of a double, or encodes it.
  void code(ArithmeticDecoder& decoder, std::uint64_t& time) {
    // An encoder changes to a sequence only to go on with that one.
    for (int changes = 0; changes < 4; ++changes) {
      if (!(differences_[current_] == 0 ? decode_first(decoder) : decode_next(decoder))) continue;
      time = times_[current_];
      return;
    }
    throw Corrupt("the compressed GPS times are damaged");
  }

  void code(ArithmeticEncoder& encoder, const std::uint64_t& time) {
    const bool is_first = differences_[current_] == 0;
    const auto put = [&](unsigned of_first, unsigned of_next) {
      is_first ? encoder.symbol(first_, of_first) : encoder.symbol(next_, of_next);
    };
    if (kHasUnchanged && time == times_[current_]) return put(0, kUnchanged);
    if (auto difference = difference_to(current_, time)) {
      const unsigned symbol = is_first ? 0 : factor_symbol(*difference);
      put(kFirstDifference, symbol);
      return is_first ? code_first(encoder, *difference) : code_next(encoder, symbol, *difference);
    }
    for (unsigned step = 1; step < 4; ++step) {
      if (!difference_to((current_ + step) % 4, time)) continue;
      put(kFirstFull + step, kFull + step);
      change_sequence(step);
      return code(encoder, time);
    }
    put(kFirstFull, kFull);
    integers_.encode(encoder, high_half(times_[current_]), high_half(time), kHighHalf);
    encoder.bits(static_cast<std::uint32_t>(time), 32);
    begin_sequence(time);
  }

 private:
  static constexpr bool kHasUnchanged = kCodes == GpsTimeCodes::kGpsTime11;

  // Symbols of a sequence without a difference.
  static constexpr unsigned kFirstDifference = kHasUnchanged ? 1 : 0;
  static constexpr unsigned kFirstFull = kFirstDifference + 1;
  static constexpr unsigned kFirstSymbols = kFirstFull + 4;
  // Symbols of one with a difference: factors 0 to 500, then -1 to -10, then these.
  static constexpr unsigned kLargestFactor = 500, kSmallestFactor = 510;
  static constexpr unsigned kUnchanged = kSmallestFactor + 1;
  static constexpr unsigned kFull = kUnchanged + (kHasUnchanged ? 1 : 0);
  static constexpr unsigned kSymbols = kFull + 4;

  // Contexts of the integers.
  static constexpr unsigned kFirst = 0, kSame = 1, kFewTimes = 2, kManyTimes = 3, kMostTimes = 4,
                            kNegative = 5, kMostNegative = 6, kZero = 7, kHighHalf = 8;

  // Both return whether the time is known, and not only its sequence.
  bool decode_first(ArithmeticDecoder& decoder) {
    const unsigned symbol = decoder.symbol(first_);
    if (symbol > kFirstFull) return change_sequence(symbol - kFirstFull);
    if (symbol == kFirstFull) {
      decode_full(decoder);
    } else if (symbol == kFirstDifference) {
      std::int32_t difference = 0;
      code_first(decoder, difference);
    }
    return true;
  }

  bool decode_next(ArithmeticDecoder& decoder) {
    const unsigned symbol = decoder.symbol(next_);
    if (symbol > kFull) return change_sequence(symbol - kFull);
    if (symbol == kFull) {
      decode_full(decoder);
    } else if (symbol <= kSmallestFactor) {
      std::int32_t difference = 0;
      code_next(decoder, symbol, difference);
    }
    return true;
  }

  template <class Coder>
  void code_first(Coder& coder, std::int32_t& difference) {
    integers_.code(coder, std::int32_t{0}, difference, kFirst);
    differences_[current_] = difference;
    extremes_[current_] = 0;
    add(difference);
  }

  template <class Coder>
  void code_next(Coder& coder, unsigned symbol, std::int32_t& difference) {
    integers_.code(coder, predict(symbol), difference, factor_context(symbol));
    go_on(symbol, difference);
  }

  // Returns the symbol of the factor that is nearest.
  unsigned factor_symbol(std::int32_t difference) const {
    const double factor = std::round(static_cast<double>(difference) / differences_[current_]);
    constexpr double kMost = kLargestFactor, kLeast = -static_cast<double>(kSmallestFactor - kLargestFactor);
    const auto nearest = static_cast<int>(std::clamp(factor, kLeast, kMost));
    return nearest >= 0 ? static_cast<unsigned>(nearest) : kLargestFactor + static_cast<unsigned>(-nearest);
  }

  // Returns the difference that the symbol of a factor stands for.
  std::int32_t predict(unsigned symbol) const {
    const std::uint32_t factor = symbol > kLargestFactor ? 0u - (symbol - kLargestFactor) : symbol;
    return static_cast<std::int32_t>(factor * static_cast<std::uint32_t>(differences_[current_]));
  }

  void go_on(unsigned symbol, std::int32_t difference) {
    add(difference);
    if (symbol == 1) {
      extremes_[current_] = 0;
    } else if (symbol == 0 || symbol == kLargestFactor || symbol == kSmallestFactor) {
      // The fourth in succession that does not fit the last difference well: it becomes the last one.
      if (++extremes_[current_] > 3) {
        differences_[current_] = difference;
        extremes_[current_] = 0;
      }
    }
  }

  // Returns nothing if the difference does not fit 32 bits.
  std::optional<std::int32_t> difference_to(unsigned sequence, std::uint64_t time) const {
    const auto difference = static_cast<std::int64_t>(time - times_[sequence]);
    if (difference != static_cast<std::int32_t>(difference)) return std::nullopt;
    return static_cast<std::int32_t>(difference);
  }

  static unsigned factor_context(unsigned symbol) {
    if (symbol == 0) return kZero;
    if (symbol == 1) return kSame;
    if (symbol < 10) return kFewTimes;
    if (symbol < kLargestFactor) return kManyTimes;
    if (symbol == kLargestFactor) return kMostTimes;
    return symbol < kSmallestFactor ? kNegative : kMostNegative;
  }

  bool change_sequence(unsigned by) {
    current_ = (current_ + by) % 4;
    return false;
  }

  void add(std::int32_t difference) {
    times_[current_] += static_cast<std::uint64_t>(std::int64_t{difference});
  }

  void decode_full(ArithmeticDecoder& decoder) {
    const std::uint64_t high = integers_.decode(decoder, high_half(times_[current_]), kHighHalf);
    begin_sequence(high << 32 | decoder.bits(32));
  }

  void begin_sequence(std::uint64_t time) {
    newest_ = (newest_ + 1) % 4;
    current_ = newest_;
    times_[current_] = time;
    differences_[current_] = 0;
    extremes_[current_] = 0;
  }

  static std::uint32_t high_half(std::uint64_t time) { return static_cast<std::uint32_t>(time >> 32); }

  std::array<std::uint64_t, 4> times_{};
  std::array<std::int32_t, 4> differences_{};
  std::array<int, 4> extremes_{};
  unsigned current_ = 0, newest_ = 0;

  SymbolModel<kFirstSymbols> first_;
  SymbolModel<kSymbols> next_;
  IntegerCoder<32, 9> integers_;
};

}  // namespace lacuna::io::laz
