// SPDX-License-Identifier: Apache-2.0
#include "io/read/laz/point14.hpp"

#include "io/read/laz/predicted_values.hpp"

namespace lacuna::io::laz {

template <class Layer>
Point14<Layer>::Point14(const std::byte* first, std::span<Layer, kLayers> layers)
    : layers_(layers), channel_(point14::channel_of(first)) {
  channels_[channel_] = std::make_unique<point14::Channel>(point14::read_fields(first));
  if constexpr (Layer::kEncodes) {
    layers_[kReturnsXy].has_changes = true;  // a chunk always has it
  } else if (!layers_[kReturnsXy].decoder) {
    throw Corrupt("a chunk of compressed points has no layer of coordinates");
  }
}

template <class Layer>
void Point14<Layer>::code(ItemByte<Layer>* item) {
  point14::Fields now{};
  unsigned channel_of_item = 0;
  if constexpr (Layer::kEncodes) {
    now = point14::read_fields(item);
    channel_of_item = point14::channel_of(item);
  }
  const unsigned changed = code_changes(now, channel_of_item);
  point14::Channel& channel = *channels_[channel_];
  if constexpr (!Layer::kEncodes) now = channel.last;
  code_returns(channel, now, changed);
  code_position(channel, now, changed & point14::kGpsTime);
  code_attributes(channel, now, changed);
  channel.last_has_new_time = changed & point14::kGpsTime;
  channel.last = now;
  if constexpr (!Layer::kEncodes) point14::write_fields(now, channel_, item);
}

template <class Layer>
unsigned Point14<Layer>::changes_to(const point14::Fields& now, unsigned channel) const {
  const point14::Fields& last = channels_[channels_[channel] ? channel : channel_]->last;
  const unsigned step = (now.return_number + 16u - last.return_number) % 16;
  const unsigned of_return = step < 2 ? step : step == 15 ? 2u : point14::kReturnNumber;
  return of_return | (now.number_of_returns != last.number_of_returns ? point14::kNumberOfReturns : 0) |
         (now.scan_angle != last.scan_angle ? point14::kScanAngle : 0) |
         (now.gps_time != last.gps_time ? point14::kGpsTime : 0) |
         (now.point_source != last.point_source ? point14::kPointSource : 0) |
         (channel != channel_ ? point14::kScannerChannel : 0);
}

// Codes what changed, by the models of the last point's channel; goes over to this point's channel. An
// encoder knows the point and its channel.
template <class Layer>
unsigned Point14<Layer>::code_changes(const point14::Fields& now, unsigned channel) {
  point14::Channel& before = *channels_[channel_];
  unsigned changed = Layer::kEncodes ? changes_to(now, channel) : 0;
  layers_[kReturnsXy].code([&](auto& coder) {
    coder.code(before.changed[before.change_context()], changed);
    changed_channel_ = changed & point14::kScannerChannel;
    if (!changed_channel_) return;
    unsigned step = (channel + point14::kChannels - channel_ - 1) % point14::kChannels;
    coder.code(before.channel_step, step);
    channel_ = (channel_ + step + 1) % point14::kChannels;
  });
  if (!channels_[channel_]) channels_[channel_] = std::make_unique<point14::Channel>(before.last);
  return changed;
}

template <class Layer>
void Point14<Layer>::code_returns(point14::Channel& channel, point14::Fields& now, unsigned changed) {
  const point14::Fields& last = channel.last;
  layers_[kReturnsXy].code([&](auto& coder) {
    if (changed & point14::kNumberOfReturns)
      coder.code(channel.number_of_returns[last.number_of_returns], now.number_of_returns);
    const unsigned of_return = changed & point14::kReturnNumber;
    if (of_return == point14::kReturnNumber && changed & point14::kGpsTime)
      return coder.code(channel.return_number[last.return_number], now.return_number);
    unsigned step = of_return < 2 ? of_return : 15;
    if (of_return == point14::kReturnNumber) {
      step = (now.return_number + 16u - last.return_number) % 16 - 2;
      coder.code(channel.return_number_step, step);
      step += 2;
    }
    now.return_number = static_cast<std::uint8_t>((last.return_number + step) % 16);
  });
}

template <class Layer>
void Point14<Layer>::code_position(point14::Channel& channel, point14::Fields& now, bool new_time) {
  const point14::Fields& last = channel.last;
  const bool only = now.number_of_returns == 1;
  const unsigned context = point14::return_context(now, new_time);
  layers_[kReturnsXy].code([&](auto& coder) {
    StreamingMedian &x_median = channel.x_medians[context], &y_median = channel.y_medians[context];
    std::int32_t dx = wrapped_difference(now.x, last.x), dy = wrapped_difference(now.y, last.y);
    channel.dx.code(coder, x_median.middle(), dx, only);
    x_median.add(dx);
    now.x = wrapped_sum(last.x, dx);
    channel.dy.code(coder, y_median.middle(), dy, k_context(channel.dx.k(), kLargestYContext, only));
    y_median.add(dy);
    now.y = wrapped_sum(last.y, dy);
  });
  layers_[kZ].code(last.z, now.z, [&](auto& coder) {
    const unsigned k = (channel.dx.k() + channel.dy.k()) / 2;
    std::int32_t& z = channel.last_z[point14::height_level(now)];
    channel.z.code(coder, z, now.z, k_context(k, kLargestZContext, only));
    z = now.z;
  });
}

template <class Layer>
void Point14<Layer>::code_attributes(point14::Channel& channel, point14::Fields& now, unsigned changed) {
  const point14::Fields& last = channel.last;
  const bool new_time = changed & point14::kGpsTime;
  const unsigned place = point14::place_in_pulse(now);
  layers_[kClassification].code(last.classification, now.classification, [&](auto& coder) {
    coder.code(channel.classification[point14::classification_context(last, place)], now.classification);
  });
  layers_[kFlags].code(last.flags, now.flags,
                       [&](auto& coder) { coder.code(channel.flags[last.flags], now.flags); });
  layers_[kIntensity].code(last.intensity, now.intensity, [&](auto& coder) {
    std::uint16_t& intensity = channel.last_intensities[place * 2 + (new_time ? 1 : 0)];
    channel.intensity.code(coder, intensity, now.intensity, place);
    intensity = now.intensity;
  });
  if (changed & point14::kScanAngle) {
    layers_[kScanAngle].code(last.scan_angle, now.scan_angle, [&](auto& coder) {
      channel.scan_angle.code(coder, last.scan_angle, now.scan_angle, new_time);
    });
  }
  layers_[kUserData].code(last.user_data, now.user_data, [&](auto& coder) {
    coder.code(channel.user_data[last.user_data / 4u], now.user_data);
  });
  if (changed & point14::kPointSource) {
    layers_[kPointSource].code(last.point_source, now.point_source, [&](auto& coder) {
      channel.point_source.code(coder, last.point_source, now.point_source);
    });
  }
  if (new_time) {
    layers_[kGpsTime].code(last.gps_time, now.gps_time,
                           [&](auto& coder) { channel.gps_times.code(coder, now.gps_time); });
  }
}

template class Point14<DecodedLayer>;
template class Point14<EncodedLayer>;

}  // namespace lacuna::io::laz
