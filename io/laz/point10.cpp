// SPDX-License-Identifier: Apache-2.0
#include "io/laz/point10.hpp"

#include "io/laz/wrapped.hpp"

#include <cstring>

namespace lacuna::io::laz {
namespace {

// By number of returns, then by return number: possible pairs have a context of their own up to five returns.
constexpr std::uint8_t kReturnContext[8][8] = {
    {15, 14, 13, 12, 11, 10, 9, 8},  {14, 0, 1, 3, 6, 10, 10, 9},    {13, 1, 2, 4, 7, 11, 11, 10},
    {12, 3, 4, 5, 8, 12, 12, 11},    {11, 6, 7, 8, 9, 13, 13, 12},   {10, 10, 11, 12, 13, 14, 14, 13},
    {9, 10, 11, 12, 13, 14, 15, 14}, {8, 9, 10, 11, 12, 13, 14, 15},
};

// Bits of the symbol that says which fields differ from the last point's.
constexpr unsigned kPointSource = 1, kUserData = 2, kScanAngle = 4, kClassification = 8, kIntensity = 16,
                   kReturns = 32;

}  // namespace

Point10::Point10(const std::byte* first) {
  std::memcpy(&last_, first, kBytes);
}

void Point10::decode(ArithmeticDecoder& decoder, std::byte* item) {
  const unsigned changed = decoder.symbol(changed_);
  if (changed & kReturns) {
    last_.returns = static_cast<std::uint8_t>(decoder.symbol(returns_[last_.returns]));
  }
  const unsigned r = last_.returns & 7, n = last_.returns >> 3 & 7;
  const unsigned context = kReturnContext[n][r];

  if (changed & kIntensity) {
    last_intensities_[context] = static_cast<std::uint16_t>(
        intensity_.decode(decoder, last_intensities_[context], std::min(context, 3u)));
  }
  last_.intensity = last_intensities_[context];
  if (changed & kClassification) {
    last_.classification = static_cast<std::uint8_t>(decoder.symbol(classification_[last_.classification]));
  }
  if (changed & kScanAngle) {
    const unsigned direction = last_.returns >> 6 & 1;
    last_.scan_angle = static_cast<std::uint8_t>(last_.scan_angle + decoder.symbol(scan_angle_[direction]));
  }
  if (changed & kUserData) {
    last_.user_data = static_cast<std::uint8_t>(decoder.symbol(user_data_[last_.user_data]));
  }
  if (changed & kPointSource) {
    last_.point_source = static_cast<std::uint16_t>(point_source_.decode(decoder, last_.point_source));
  }

  const bool only = n == 1;
  const std::int32_t dx = dx_.decode_signed(decoder, x_medians_[context].middle(), only);
  x_medians_[context].add(dx);
  last_.x = wrapped_sum(last_.x, dx);
  const std::int32_t dy =
      dy_.decode_signed(decoder, y_medians_[context].middle(), k_context(dx_.k(), kLargestYContext, only));
  y_medians_[context].add(dy);
  last_.y = wrapped_sum(last_.y, dy);
  std::int32_t& height = last_heights_[return_level(n, r)];
  height = z_.decode_signed(decoder, height, k_context((dx_.k() + dy_.k()) / 2, kLargestZContext, only));
  last_.z = height;

  std::memcpy(item, &last_, kBytes);
}

void Point10::encode(ArithmeticEncoder& encoder, const std::byte* item) {
  Fields now;
  std::memcpy(&now, item, kBytes);
  const unsigned r = now.returns & 7, n = now.returns >> 3 & 7;
  const unsigned context = kReturnContext[n][r];
  std::uint16_t& intensity = last_intensities_[context];

  const unsigned changed = (now.returns != last_.returns ? kReturns : 0) |
                           (now.intensity != intensity ? kIntensity : 0) |
                           (now.classification != last_.classification ? kClassification : 0) |
                           (now.scan_angle != last_.scan_angle ? kScanAngle : 0) |
                           (now.user_data != last_.user_data ? kUserData : 0) |
                           (now.point_source != last_.point_source ? kPointSource : 0);
  encoder.symbol(changed_, changed);
  if (changed & kReturns) encoder.symbol(returns_[last_.returns], now.returns);
  if (changed & kIntensity) {
    intensity_.encode(encoder, intensity, now.intensity, std::min(context, 3u));
    intensity = now.intensity;
  }
  if (changed & kClassification) encoder.symbol(classification_[last_.classification], now.classification);
  if (changed & kScanAngle) {
    const unsigned direction = now.returns >> 6 & 1;
    encoder.symbol(scan_angle_[direction], static_cast<std::uint8_t>(now.scan_angle - last_.scan_angle));
  }
  if (changed & kUserData) encoder.symbol(user_data_[last_.user_data], now.user_data);
  if (changed & kPointSource) point_source_.encode(encoder, last_.point_source, now.point_source);

  const bool only = n == 1;
  const std::int32_t dx = wrapped_difference(now.x, last_.x), dy = wrapped_difference(now.y, last_.y);
  dx_.encode_signed(encoder, x_medians_[context].middle(), dx, only);
  x_medians_[context].add(dx);
  dy_.encode_signed(encoder, y_medians_[context].middle(), dy, k_context(dx_.k(), kLargestYContext, only));
  y_medians_[context].add(dy);
  std::int32_t& height = last_heights_[return_level(n, r)];
  z_.encode_signed(encoder, height, now.z, k_context((dx_.k() + dy_.k()) / 2, kLargestZContext, only));
  height = now.z;
  last_ = now;
}

}  // namespace lacuna::io::laz
