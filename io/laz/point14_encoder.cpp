// SPDX-License-Identifier: Apache-2.0
#include "io/laz/point14_encoder.hpp"

#include "io/laz/wrapped.hpp"

namespace lacuna::io::laz {

Point14Encoder::Point14Encoder(const std::byte* first) : channel_(point14::channel_of(first)) {
  channels_[channel_] = std::make_unique<point14::Channel>(point14::read_fields(first));
  layers_[kReturnsXyLayer].has_changes = true;  // a chunk always has it
}

void Point14Encoder::encode(const std::byte* item) {
  const point14::Fields now = point14::read_fields(item);
  const unsigned changed = encode_changes(now, point14::channel_of(item));
  point14::Channel& channel = *channels_[channel_];
  encode_returns(channel, now, changed);
  encode_position(channel, now, changed & point14::kGpsTime);
  encode_attributes(channel, now, changed);
  channel.last_has_new_time = changed & point14::kGpsTime;
  channel.last = now;
}

// Encodes what changed, by the models of the last point's channel; goes over to this point's channel.
unsigned Point14Encoder::encode_changes(const point14::Fields& now, unsigned channel) {
  point14::Channel& before = *channels_[channel_];
  changed_channel_ = channel != channel_;
  const bool is_new = !channels_[channel];
  const point14::Fields& last = is_new ? before.last : channels_[channel]->last;
  const unsigned step = (now.return_number + 16u - last.return_number) % 16;
  const unsigned changed = (step == 0    ? 0u
                            : step == 1  ? 1u
                            : step == 15 ? 2u
                                         : point14::kReturnNumber) |
                           (now.number_of_returns != last.number_of_returns ? point14::kNumberOfReturns : 0) |
                           (now.scan_angle != last.scan_angle ? point14::kScanAngle : 0) |
                           (now.gps_time != last.gps_time ? point14::kGpsTime : 0) |
                           (now.point_source != last.point_source ? point14::kPointSource : 0) |
                           (changed_channel_ ? point14::kScannerChannel : 0);
  ArithmeticEncoder& encoder = layer(kReturnsXyLayer);
  encoder.symbol(before.changed[before.change_context()], changed);
  if (changed_channel_) {
    encoder.symbol(before.channel_step, (channel + point14::kChannels - channel_ - 1) % point14::kChannels);
    if (is_new) channels_[channel] = std::make_unique<point14::Channel>(before.last);
    channel_ = channel;
  }
  return changed;
}

void Point14Encoder::encode_returns(point14::Channel& channel, const point14::Fields& now, unsigned changed) {
  const point14::Fields& last = channel.last;
  ArithmeticEncoder& encoder = layer(kReturnsXyLayer);
  if (changed & point14::kNumberOfReturns)
    encoder.symbol(channel.number_of_returns[last.number_of_returns], now.number_of_returns);
  if ((changed & point14::kReturnNumber) != point14::kReturnNumber) return;
  if (changed & point14::kGpsTime) {
    encoder.symbol(channel.return_number[last.return_number], now.return_number);
  } else {
    encoder.symbol(channel.return_number_step, (now.return_number + 16u - last.return_number) % 16 - 2);
  }
}

void Point14Encoder::encode_position(point14::Channel& channel, const point14::Fields& now, bool new_time) {
  const point14::Fields& last = channel.last;
  const bool only = now.number_of_returns == 1;
  const unsigned context = point14::return_context(now, new_time);
  ArithmeticEncoder& encoder = layer(kReturnsXyLayer);

  StreamingMedian& x_median = channel.x_medians[context];
  const std::int32_t dx = wrapped_difference(now.x, last.x);
  channel.dx.encode_signed(encoder, x_median.middle(), dx, only);
  x_median.add(dx);

  StreamingMedian& y_median = channel.y_medians[context];
  const std::int32_t dy = wrapped_difference(now.y, last.y);
  channel.dy.encode_signed(encoder, y_median.middle(), dy, k_context(channel.dx.k(), kLargestYContext, only));
  y_median.add(dy);

  const unsigned k = (channel.dx.k() + channel.dy.k()) / 2;
  std::int32_t& z = channel.last_z[point14::height_level(now)];
  channel.z.encode_signed(layer(kZLayer), z, now.z, k_context(k, kLargestZContext, only));
  z = now.z;
  layers_[kZLayer].note(now.z != last.z);
}

void Point14Encoder::encode_attributes(point14::Channel& channel, const point14::Fields& now,
                                       unsigned changed) {
  const point14::Fields& last = channel.last;
  const bool new_time = changed & point14::kGpsTime;
  const unsigned place = point14::place_in_pulse(now);

  layer(kClassificationLayer)
      .symbol(channel.classification[point14::classification_context(last, place)], now.classification);
  layers_[kClassificationLayer].note(now.classification != last.classification);
  layer(kFlagsLayer).symbol(channel.flags[last.flags], now.flags);
  layers_[kFlagsLayer].note(now.flags != last.flags);

  std::uint16_t& intensity = channel.last_intensities[place * 2 + (new_time ? 1 : 0)];
  channel.intensity.encode(layer(kIntensityLayer), intensity, now.intensity, place);
  intensity = now.intensity;
  layers_[kIntensityLayer].note(now.intensity != last.intensity);

  if (changed & point14::kScanAngle) {
    channel.scan_angle.encode(layer(kScanAngleLayer), last.scan_angle, now.scan_angle, new_time);
    layers_[kScanAngleLayer].note(true);
  }
  layer(kUserDataLayer).symbol(channel.user_data[last.user_data / 4u], now.user_data);
  layers_[kUserDataLayer].note(now.user_data != last.user_data);
  if (changed & point14::kPointSource) {
    channel.point_source.encode(layer(kPointSourceLayer), last.point_source, now.point_source);
    layers_[kPointSourceLayer].note(true);
  }
  if (new_time) {
    channel.gps_times.encode(layer(kGpsTimeLayer), now.gps_time);
    layers_[kGpsTimeLayer].note(true);
  }
}

}  // namespace lacuna::io::laz
