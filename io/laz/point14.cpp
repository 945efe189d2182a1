// SPDX-License-Identifier: Apache-2.0
#include "io/laz/point14.hpp"

#include "io/laz/wrapped.hpp"

namespace lacuna::io::laz {

Point14Decoder::Point14Decoder(const std::byte* first, Layers& layers)
    : returns_xy_(layers.next()),
      z_(layers.next()),
      classification_(layers.next()),
      flags_(layers.next()),
      intensity_(layers.next()),
      scan_angle_(layers.next()),
      user_data_(layers.next()),
      point_source_(layers.next()),
      gps_time_(layers.next()),
      channel_(point14::channel_of(first)) {
  if (!returns_xy_) throw Corrupt("a chunk of compressed points has no layer of coordinates");
  channels_[channel_] = std::make_unique<point14::Channel>(point14::read_fields(first));
}

void Point14Decoder::decode(std::byte* item) {
  const unsigned changed = decode_changes();
  point14::Channel& channel = *channels_[channel_];
  decode_returns(channel, changed);
  decode_position(channel, changed & point14::kGpsTime);
  decode_attributes(channel, changed);
  channel.last_has_new_time = changed & point14::kGpsTime;
  point14::write_fields(channel.last, channel_, item);
}

// Decodes what changed, by the models of the last point's channel; goes over to this point's channel.
unsigned Point14Decoder::decode_changes() {
  point14::Channel& before = *channels_[channel_];
  const unsigned changed = returns_xy_->symbol(before.changed[before.change_context()]);
  changed_channel_ = changed & point14::kScannerChannel;
  if (changed_channel_) {
    channel_ = (channel_ + returns_xy_->symbol(before.channel_step) + 1) % point14::kChannels;
    if (!channels_[channel_]) channels_[channel_] = std::make_unique<point14::Channel>(before.last);
  }
  return changed;
}

void Point14Decoder::decode_returns(point14::Channel& channel, unsigned changed) {
  point14::Fields& last = channel.last;
  ArithmeticDecoder& decoder = *returns_xy_;
  if (changed & point14::kNumberOfReturns) {
    last.number_of_returns =
        static_cast<std::uint8_t>(decoder.symbol(channel.number_of_returns[last.number_of_returns]));
  }
  unsigned r = last.return_number;
  switch (changed & point14::kReturnNumber) {
    case 0:
      break;
    case 1:
      r += 1;
      break;
    case 2:
      r += 15;
      break;
    default:
      r = changed & point14::kGpsTime ? decoder.symbol(channel.return_number[r])
                                      : r + decoder.symbol(channel.return_number_step) + 2;
  }
  last.return_number = static_cast<std::uint8_t>(r % 16);
}

void Point14Decoder::decode_position(point14::Channel& channel, bool new_time) {
  point14::Fields& last = channel.last;
  const bool only = last.number_of_returns == 1;
  const unsigned context = point14::return_context(last, new_time);

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
    std::int32_t& z = channel.last_z[point14::height_level(last)];
    z = channel.z.decode_signed(*z_, z, k_context(k, kLargestZContext, only));
    last.z = z;
  }
}

void Point14Decoder::decode_attributes(point14::Channel& channel, unsigned changed) {
  point14::Fields& last = channel.last;
  const bool new_time = changed & point14::kGpsTime;
  const unsigned place = point14::place_in_pulse(last);
  if (classification_) {
    const unsigned context = point14::classification_context(last, place);
    last.classification = static_cast<std::uint8_t>(classification_->symbol(channel.classification[context]));
  }
  if (flags_) last.flags = static_cast<std::uint8_t>(flags_->symbol(channel.flags[last.flags]));
  if (intensity_) {
    std::uint16_t& intensity = channel.last_intensities[place * 2 + (new_time ? 1 : 0)];
    intensity = static_cast<std::uint16_t>(channel.intensity.decode(*intensity_, intensity, place));
    last.intensity = intensity;
  }
  if (scan_angle_ && changed & point14::kScanAngle) {
    last.scan_angle =
        static_cast<std::uint16_t>(channel.scan_angle.decode(*scan_angle_, last.scan_angle, new_time));
  }
  if (user_data_) {
    last.user_data = static_cast<std::uint8_t>(user_data_->symbol(channel.user_data[last.user_data / 4u]));
  }
  if (point_source_ && changed & point14::kPointSource) {
    last.point_source =
        static_cast<std::uint16_t>(channel.point_source.decode(*point_source_, last.point_source));
  }
  if (gps_time_ && new_time) last.gps_time = channel.gps_times.decode(*gps_time_);
}

}  // namespace lacuna::io::laz
