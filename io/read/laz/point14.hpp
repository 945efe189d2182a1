// SPDX-License-Identifier: Apache-2.0
// The layers of a chunk of point formats 6 to 8: a stream for each attribute (LAZ, compressor 3).
#pragma once

#include "io/read/files/number.hpp"
#include "io/read/laz/arithmetic_coder.hpp"
#include "io/read/laz/predicted_values.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace lacuna::io::laz {

// A layer that is read. It has no stream where the attribute is the first point's for all points.
struct DecodedLayer {
  static constexpr bool kEncodes = false;
  std::optional<ArithmeticDecoder> decoder;

  // Calls code(decoder), which sets `now` to the next point's value. Before, `now` is the last point's.
  template <class Value, class Code>
  void code(const Value& /*last*/, const Value& /*now*/, Code&& code) {
    if (decoder) code(*decoder);
  }
  // Does the same for a layer that always has a stream.
  template <class Code>
  void code(Code&& code) {
    code(*decoder);
  }
};

// A layer that is written.
struct EncodedLayer {
  static constexpr bool kEncodes = true;
  ArithmeticEncoder encoder;
  bool has_changes = false;  // any point has another value than the one before it in its channel

  // Calls code(encoder), which reads `now`.
  template <class Value, class Code>
  void code(const Value& last, const Value& now, Code&& code) {
    has_changes = has_changes || last != now;
    code(encoder);
  }
  template <class Code>
  void code(Code&& code) {
    code(encoder);
  }

  // Nothing where the attribute is the first point's for all points. Nothing can be encoded afterwards.
  std::vector<std::byte> finish() { return has_changes ? encoder.finish() : std::vector<std::byte>(); }
};

// A byte of a record: an encoder only reads it.
template <class Layer>
using ItemByte = std::conditional_t<Layer::kEncodes, const std::byte, std::byte>;

// The fields of a POINT14, and the state of a scanner channel.

namespace point14 {

inline constexpr unsigned kChannels = 4;

// Bits of the symbol that says what changed. The two lowest are of the return number: equal, one more, one
// less, or coded.
inline constexpr unsigned kReturnNumber = 3, kNumberOfReturns = 4, kScanAngle = 8, kGpsTime = 16,
                          kPointSource = 32, kScannerChannel = 64;

// All fields of a point but the scanner channel.
struct Fields {
  std::int32_t x, y, z;
  std::uint16_t intensity;
  std::uint8_t return_number, number_of_returns;
  std::uint8_t flags;  // classification flags, scan direction << 4, edge of flight line << 5
  std::uint8_t classification;
  std::uint8_t user_data;
  std::uint16_t scan_angle;  // as the bits of a signed number
  std::uint16_t point_source;
  std::uint64_t gps_time;  // the bits of a double
};

inline Fields read_fields(const std::byte* item) {
  const unsigned returns = std::to_integer<unsigned>(item[14]), bits = std::to_integer<unsigned>(item[15]);
  return {
      .x = load<std::int32_t>(item),
      .y = load<std::int32_t>(item + 4),
      .z = load<std::int32_t>(item + 8),
      .intensity = load<std::uint16_t>(item + 12),
      .return_number = static_cast<std::uint8_t>(returns & 15),
      .number_of_returns = static_cast<std::uint8_t>(returns >> 4),
      .flags = static_cast<std::uint8_t>((bits & 15) | (bits >> 6) << 4),
      .classification = load<std::uint8_t>(item + 16),
      .user_data = load<std::uint8_t>(item + 17),
      .scan_angle = load<std::uint16_t>(item + 18),
      .point_source = load<std::uint16_t>(item + 20),
      .gps_time = load<std::uint64_t>(item + 22),
  };
}

inline unsigned channel_of(const std::byte* item) {
  return std::to_integer<unsigned>(item[15]) >> 4 & 3;
}

inline void write_fields(const Fields& fields, unsigned channel, std::byte* item) {
  store(item, fields.x);
  store(item + 4, fields.y);
  store(item + 8, fields.z);
  store(item + 12, fields.intensity);
  item[14] = static_cast<std::byte>(fields.number_of_returns << 4 | fields.return_number);
  item[15] = static_cast<std::byte>((fields.flags & 15) | channel << 4 | (fields.flags >> 4) << 6);
  store(item + 16, fields.classification);
  store(item + 17, fields.user_data);
  store(item + 18, fields.scan_angle);
  store(item + 20, fields.point_source);
  store(item + 22, fields.gps_time);
}

// Returns the context of x and y differences.
inline unsigned return_context(const Fields& fields, bool new_time) {
  // The number of returns chooses the text, the return number its digit.
  static constexpr char kContexts[16][17] = {
      "0123453445555555", "1013333333333333", "2124444444433333", "3345444444444444",
      "4344544444444444", "5344454444444444", "3344445444444444", "4344444544444444",
      "4344444454444444", "5344444445444444", "5344444444544444", "5334444444455444",
      "5334444444455544", "5334444444445554", "5334444444444555", "5334444444444455",
  };
  const char digit = kContexts[fields.number_of_returns][fields.return_number];
  return static_cast<unsigned>(digit - '0') * 2 + (new_time ? 1 : 0);
}

// 1 for the first return of a pulse, 2 for the last, 3 for the only one, 0 for one between.
inline unsigned place_in_pulse(const Fields& fields) {
  return (fields.return_number == 1 ? 1u : 0u) + (fields.return_number >= fields.number_of_returns ? 2u : 0u);
}
inline constexpr unsigned kOnlyReturn = 3;

// Returns which of the last heights predicts the height of the point.
inline unsigned height_level(const Fields& fields) {
  return std::min(return_level(fields.number_of_returns, fields.return_number), 7u);
}

// Returns the context of the classification.
inline unsigned classification_context(const Fields& last, unsigned place) {
  return (last.classification & 31u) * 2 + (place == kOnlyReturn ? 1 : 0);
}

// All models and last values of a scanner channel. A new channel begins with the values of the point before.
struct Channel {
  explicit Channel(const Fields& first) : last(first), gps_times(first.gps_time) {
    last_z.fill(first.z);
    last_intensities.fill(first.intensity);
  }

  // The context of what changed: by the last point's place in its pulse, and by last_has_new_time.
  unsigned change_context() const { return place_in_pulse(last) | (last_has_new_time ? 4u : 0u); }

  Fields last;
  bool last_has_new_time = false;

  // Layer of channel, returns, x and y.
  std::array<SymbolModel<128>, 8> changed;
  SymbolModel<3> channel_step;
  ModelByValue<16, 16> number_of_returns, return_number;  // by the last one
  SymbolModel<13> return_number_step;
  IntegerCoder<32, 2> dx;
  IntegerCoder<32, 22> dy;
  std::array<StreamingMedian, 12> x_medians, y_medians;  // by return_context()

  // A layer each.
  IntegerCoder<32, 20> z;
  std::array<std::int32_t, 8> last_z;  // by height_level()
  ModelByValue<256, 64> classification;
  ModelByValue<64, 64> flags;
  IntegerCoder<16, 4> intensity;
  std::array<std::uint16_t, 8> last_intensities;  // by place in the pulse, and by new time
  IntegerCoder<16, 2> scan_angle;
  ModelByValue<256, 64> user_data;
  IntegerCoder<16> point_source;
  GpsTimeCoder<GpsTimeCodes::kPoint14> gps_times;
};

}  // namespace point14

// POINT14, versions 3 and 4: the 30 bytes that point formats 6 to 8 begin with (LAZ, "POINT14").

// Decodes or encodes points, by the kind of their layers.
template <class Layer>
class Point14 {
 public:
  static constexpr std::size_t kLayers = 9;

  // `first`: the chunk's first point, which is not compressed. The layers outlive this. Throws `Corrupt` if
  // the first one, which every chunk has, is empty.
  Point14(const std::byte* first, std::span<Layer, kLayers> layers);

  // Decodes the next point to `item`, or encodes it from there.
  void code(ItemByte<Layer>* item);

  unsigned channel() const { return channel_; }
  // Whether the last point was the first after one of another channel.
  bool changed_channel() const { return changed_channel_; }

 private:
  // The layers, in the order of the chunk.
  enum LayerIndex : std::size_t {
    kReturnsXy,
    kZ,
    kClassification,
    kFlags,
    kIntensity,
    kScanAngle,
    kUserData,
    kPointSource,
    kGpsTime
  };
  static_assert(kGpsTime + 1 == kLayers);

  unsigned changes_to(const point14::Fields& now, unsigned channel) const;
  unsigned code_changes(const point14::Fields& now, unsigned channel);
  void code_returns(point14::Channel& channel, point14::Fields& now, unsigned changed);
  void code_position(point14::Channel& channel, point14::Fields& now, bool new_time);
  void code_attributes(point14::Channel& channel, point14::Fields& now, unsigned changed);

  std::span<Layer, kLayers> layers_;
  std::array<std::unique_ptr<point14::Channel>, point14::kChannels> channels_;
  unsigned channel_;
  bool changed_channel_ = false;
};

}  // namespace lacuna::io::laz
