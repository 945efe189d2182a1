// SPDX-License-Identifier: Apache-2.0
// Values coded as their difference to a prediction, which POINT10 and POINT14 share. They are integers, GPS
// times, medians that predict coordinates, and the contexts that choose the models.
#pragma once

#include "io/read/laz/arithmetic_coder.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

namespace lacuna::io::laz {

// Sums and differences of coordinates modulo 2^32, since coordinates of damaged or far data may overflow.

inline std::int32_t wrapped_sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

inline std::int32_t wrapped_difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

// Contexts by which the decoders of POINT10 and POINT14 choose their models.

// Returns how many returns of its pulse a point is from the last one; |n - r| also for return numbers that
// are not possible.
inline unsigned return_level(unsigned number_of_returns, unsigned return_number) {
  return number_of_returns > return_number ? number_of_returns - return_number
                                           : return_number - number_of_returns;
}

// The context of the y difference by the k of the x difference, and of z by the mean k of both. It is an even
// number up to `largest`, and the next odd one for the only return of a pulse.
inline unsigned k_context(unsigned k, unsigned largest, bool only_return) {
  return std::min(k & ~1u, largest) + (only_return ? 1 : 0);
}
inline constexpr unsigned kLargestYContext = 20;
inline constexpr unsigned kLargestZContext = 18;

// A model for each value that came before; most values never come, so a model is made when it is first
// needed.
template <unsigned kSymbols, unsigned kContexts>
class ModelByValue {
 public:
  SymbolModel<kSymbols>& operator[](unsigned context) {
    auto& model = models_[context];
    if (!model) model = std::make_unique<SymbolModel<kSymbols>>();
    return *model;
  }

 private:
  std::array<std::unique_ptr<SymbolModel<kSymbols>>, kContexts> models_;
};

// The middle of five recent values (LAZ, "Streaming median").

// Keeps five values in order. A new one takes the place of the largest or of the smallest. It replaces the
// largest until a value comes that is not below the middle, then the smallest until one comes that is not
// above it.
class StreamingMedian {
 public:
  std::int32_t middle() const { return values_[2]; }

  void add(std::int32_t value) {
    const std::int32_t middle = values_[2];
    if (replaces_largest_) {
      std::size_t at = 4;
      for (; at > 0 && value < values_[at - 1]; --at) values_[at] = values_[at - 1];
      values_[at] = value;
      replaces_largest_ = value < middle;
    } else {
      std::size_t at = 0;
      for (; at < 4 && values_[at + 1] < value; ++at) values_[at] = values_[at + 1];
      values_[at] = value;
      replaces_largest_ = value <= middle;
    }
  }

 private:
  std::array<std::int32_t, 5> values_{};
  bool replaces_largest_ = true;
};

// Integers coded as their difference to a prediction (LAZ, "Integer compressor").

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

// GPS times of GPSTIME11 version 2 and of POINT14 (LAZ, "GPSTIME11" and "POINT14, GPS time layer").

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
