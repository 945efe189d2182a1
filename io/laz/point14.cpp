// SPDX-License-Identifier: Apache-2.0
#include "io/laz/point14.hpp"

#include "io/little_endian.hpp"

namespace lacuna::io::laz {
namespace {

// Bits of the symbol that says what changed. The two lowest are of the return number: equal, one more, one
// less, or coded.
constexpr unsigned kReturnNumber = 3, kNumberOfReturns = 4, kScanAngle = 8, kGpsTime = 16, kPointSource = 32,
                   kScannerChannel = 64;

// The context of x and y differences, by number of returns (row) and return number (digit of the row).
constexpr char kReturnContext[16][17] = {
    "0123453445555555", "1013333333333333", "2124444444433333", "3345444444444444",
    "4344544444444444", "5344454444444444", "3344445444444444", "4344444544444444",
    "4344444454444444", "5344444445444444", "5344444444544444", "5334444444455444",
    "5334444444455544", "5334444444445554", "5334444444444555", "5334444444444455",
};

// 1 for the first return of a pulse, 2 for the last, 3 for the only one, 0 for one between.
unsigned place_in_pulse(unsigned return_number, unsigned number_of_returns) {
  return (return_number == 1 ? 1 : 0) + (return_number >= number_of_returns ? 2 : 0);
}
constexpr unsigned kOnlyReturn = 3;

std::int32_t wrapped_sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

}  // namespace

struct Point14::Channel {
  explicit Channel(const Fields& first) : last(first), gps_times(first.gps_time) {
    last_z.fill(first.z);
    last_intensities.fill(first.intensity);
  }

  Fields last;
  bool last_has_new_time = false;

  // Layer of channel, returns, x and y.
  std::array<SymbolModel<128>, 8>
      changed;  // by the last point's place in its pulse, and by last_has_new_time
  SymbolModel<3> channel_step;
  ModelByValue<16, 16> number_of_returns, return_number;  // by the last one
  SymbolModel<13> return_number_step;
  IntegerDecoder<32, 2> dx;
  IntegerDecoder<32, 22> dy;
  std::array<StreamingMedian, 12> x_medians, y_medians;  // by context of return numbers, and by new time

  // A layer each.
  IntegerDecoder<32, 20> z;
  std::array<std::int32_t, 8> last_z;  // by return level
  ModelByValue<256, 64> classification;
  ModelByValue<64, 64> flags;
  IntegerDecoder<16, 4> intensity;
  std::array<std::uint16_t, 8> last_intensities;  // by place in the pulse, and by new time
  IntegerDecoder<16, 2> scan_angle;
  ModelByValue<256, 64> user_data;
  IntegerDecoder<16> point_source;
  GpsTimeDecoder<GpsTimeCodes::kPoint14> gps_times;
};

Point14::Point14(const std::byte* first, Layers& layers)
    : returns_xy_(layers.next()),
      z_(layers.next()),
      classification_(layers.next()),
      flags_(layers.next()),
      intensity_(layers.next()),
      scan_angle_(layers.next()),
      user_data_(layers.next()),
      point_source_(layers.next()),
      gps_time_(layers.next()) {
  if (!returns_xy_) throw Corrupt("a chunk of compressed points has no layer of coordinates");
  const unsigned returns = std::to_integer<unsigned>(first[14]), bits = std::to_integer<unsigned>(first[15]);
  channel_ = bits >> 4 & 3;
  channels_[channel_] = std::make_unique<Channel>(Fields{
      .x = load<std::int32_t>(first),
      .y = load<std::int32_t>(first + 4),
      .z = load<std::int32_t>(first + 8),
      .intensity = load<std::uint16_t>(first + 12),
      .return_number = static_cast<std::uint8_t>(returns & 15),
      .number_of_returns = static_cast<std::uint8_t>(returns >> 4),
      .flags = static_cast<std::uint8_t>((bits & 15) | (bits >> 6) << 4),
      .classification = load<std::uint8_t>(first + 16),
      .user_data = load<std::uint8_t>(first + 17),
      .scan_angle = load<std::uint16_t>(first + 18),
      .point_source = load<std::uint16_t>(first + 20),
      .gps_time = load<std::uint64_t>(first + 22),
  });
}

Point14::~Point14() = default;

void Point14::write(const Fields& fields, std::byte* item) const {
  store(item, fields.x);
  store(item + 4, fields.y);
  store(item + 8, fields.z);
  store(item + 12, fields.intensity);
  item[14] = static_cast<std::byte>(fields.number_of_returns << 4 | fields.return_number);
  item[15] = static_cast<std::byte>((fields.flags & 15) | channel_ << 4 | (fields.flags >> 4) << 6);
  store(item + 16, fields.classification);
  store(item + 17, fields.user_data);
  store(item + 18, fields.scan_angle);
  store(item + 20, fields.point_source);
  store(item + 22, fields.gps_time);
}

void Point14::decode(std::byte* item) {
  const unsigned changed = decode_changes();
  Channel& channel = *channels_[channel_];
  decode_returns(channel, changed);
  decode_position(channel, changed & kGpsTime);
  decode_attributes(channel, changed);
  channel.last_has_new_time = changed & kGpsTime;
  write(channel.last, item);
}

// What changed, by the models of the last point's channel; goes over to the channel of this point.
unsigned Point14::decode_changes() {
  Channel& before = *channels_[channel_];
  const unsigned place = place_in_pulse(before.last.return_number, before.last.number_of_returns);
  const unsigned changed = returns_xy_->symbol(before.changed[place | (before.last_has_new_time ? 4 : 0)]);
  changed_channel_ = changed & kScannerChannel;
  if (changed_channel_) {
    channel_ = (channel_ + returns_xy_->symbol(before.channel_step) + 1) % kChannels;
    if (!channels_[channel_]) channels_[channel_] = std::make_unique<Channel>(before.last);
  }
  return changed;
}

void Point14::decode_returns(Channel& channel, unsigned changed) {
  Fields& last = channel.last;
  ArithmeticDecoder& decoder = *returns_xy_;
  if (changed & kNumberOfReturns) {
    last.number_of_returns =
        static_cast<std::uint8_t>(decoder.symbol(channel.number_of_returns[last.number_of_returns]));
  }
  unsigned r = last.return_number;
  switch (changed & kReturnNumber) {
    case 0:
      break;
    case 1:
      r += 1;
      break;
    case 2:
      r += 15;
      break;
    default:
      r = changed & kGpsTime ? decoder.symbol(channel.return_number[r])
                             : r + decoder.symbol(channel.return_number_step) + 2;
  }
  last.return_number = static_cast<std::uint8_t>(r % 16);
}

void Point14::decode_position(Channel& channel, bool new_time) {
  Fields& last = channel.last;
  const unsigned n = last.number_of_returns, r = last.return_number;
  const bool only = n == 1;
  const unsigned context = static_cast<unsigned>(kReturnContext[n][r] - '0') * 2 + (new_time ? 1 : 0);

  StreamingMedian& x_median = channel.x_medians[context];
  const std::int32_t dx = channel.dx.decode_signed(*returns_xy_, x_median.middle(), only);
  x_median.add(dx);
  last.x = wrapped_sum(last.x, dx);

  StreamingMedian& y_median = channel.y_medians[context];
  const std::int32_t dy = channel.dy.decode_signed(*returns_xy_, y_median.middle(),
                                                   k_context(channel.dx.k(), kLargestYContext, only));
  y_median.add(dy);
  last.y = wrapped_sum(last.y, dy);

  if (z_) {
    const unsigned k = (channel.dx.k() + channel.dy.k()) / 2;
    std::int32_t& z = channel.last_z[std::min(return_level(n, r), 7u)];
    z = channel.z.decode_signed(*z_, z, k_context(k, kLargestZContext, only));
    last.z = z;
  }
}

void Point14::decode_attributes(Channel& channel, unsigned changed) {
  Fields& last = channel.last;
  const bool new_time = changed & kGpsTime;
  const unsigned place = place_in_pulse(last.return_number, last.number_of_returns);
  if (classification_) {
    const unsigned context = (last.classification & 31u) * 2 + (place == kOnlyReturn ? 1 : 0);
    last.classification = static_cast<std::uint8_t>(classification_->symbol(channel.classification[context]));
  }
  if (flags_) last.flags = static_cast<std::uint8_t>(flags_->symbol(channel.flags[last.flags]));
  if (intensity_) {
    std::uint16_t& intensity = channel.last_intensities[place * 2 + (new_time ? 1 : 0)];
    intensity = static_cast<std::uint16_t>(channel.intensity.decode(*intensity_, intensity, place));
    last.intensity = intensity;
  }
  if (scan_angle_ && changed & kScanAngle) {
    last.scan_angle =
        static_cast<std::uint16_t>(channel.scan_angle.decode(*scan_angle_, last.scan_angle, new_time));
  }
  if (user_data_) {
    last.user_data = static_cast<std::uint8_t>(user_data_->symbol(channel.user_data[last.user_data / 4u]));
  }
  if (point_source_ && changed & kPointSource) {
    last.point_source =
        static_cast<std::uint16_t>(channel.point_source.decode(*point_source_, last.point_source));
  }
  if (gps_time_ && new_time) last.gps_time = channel.gps_times.decode(*gps_time_);
}

}  // namespace lacuna::io::laz
