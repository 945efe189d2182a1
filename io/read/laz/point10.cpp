// SPDX-License-Identifier: Apache-2.0
#include "io/read/laz/point10.hpp"

#include "io/read/files/little_endian.hpp"
#include "io/read/laz/wrapped.hpp"

namespace lacuna::io::laz {
namespace {

// By number of returns, then by return number: possible pairs have a context of their own up to five returns.
constexpr std::uint8_t kReturnContext[8][8] = {
    {15, 14, 13, 12, 11, 10, 9, 8},  {14, 0, 1, 3, 6, 10, 10, 9},    {13, 1, 2, 4, 7, 11, 11, 10},
    {12, 3, 4, 5, 8, 12, 12, 11},    {11, 6, 7, 8, 9, 13, 13, 12},   {10, 10, 11, 12, 13, 14, 14, 13},
    {9, 10, 11, 12, 13, 14, 15, 14}, {8, 9, 10, 11, 12, 13, 14, 15},
};

unsigned context_of(std::uint8_t returns) {
  return kReturnContext[returns >> 3 & 7][returns & 7];
}

// Bits of the symbol that says which fields differ from the last point's.
constexpr unsigned kPointSource = 1, kUserData = 2, kScanAngle = 4, kClassification = 8, kIntensity = 16,
                   kReturns = 32;

}  // namespace

Point10::Point10(const std::byte* first) : last_(load<Fields>(first)) {}

void Point10::code(ArithmeticDecoder& decoder, std::byte* item) {
  Fields now = last_;
  code_fields(decoder, now);
  store(item, now);
}

void Point10::code(ArithmeticEncoder& encoder, const std::byte* item) {
  Fields now = load<Fields>(item);
  code_fields(encoder, now);
}

unsigned Point10::changes_to(const Fields& now) const {
  return (now.returns != last_.returns ? kReturns : 0) |
         (now.intensity != last_intensities_[context_of(now.returns)] ? kIntensity : 0) |
         (now.classification != last_.classification ? kClassification : 0) |
         (now.scan_angle != last_.scan_angle ? kScanAngle : 0) |
         (now.user_data != last_.user_data ? kUserData : 0) |
         (now.point_source != last_.point_source ? kPointSource : 0);
}

// `now` is the next point. A decoder changes it from the last point to that.
template <class Coder>
void Point10::code_fields(Coder& coder, Fields& now) {
  unsigned changed = Coder::kEncodes ? changes_to(now) : 0;
  coder.code(changed_, changed);
  if (changed & kReturns) coder.code(returns_[last_.returns], now.returns);
  const unsigned r = now.returns & 7, n = now.returns >> 3 & 7;
  const unsigned context = context_of(now.returns);

  std::uint16_t& intensity = last_intensities_[context];
  if (changed & kIntensity) {
    intensity_.code(coder, intensity, now.intensity, std::min(context, 3u));
    intensity = now.intensity;
  }
  now.intensity = intensity;
  if (changed & kClassification) coder.code(classification_[last_.classification], now.classification);
  if (changed & kScanAngle) {
    const unsigned direction = now.returns >> 6 & 1;
    auto turn = static_cast<std::uint8_t>(now.scan_angle - last_.scan_angle);
    coder.code(scan_angle_[direction], turn);
    now.scan_angle = static_cast<std::uint8_t>(last_.scan_angle + turn);
  }
  if (changed & kUserData) coder.code(user_data_[last_.user_data], now.user_data);
  if (changed & kPointSource) point_source_.code(coder, last_.point_source, now.point_source);

  const bool only = n == 1;
  std::int32_t dx = wrapped_difference(now.x, last_.x), dy = wrapped_difference(now.y, last_.y);
  dx_.code(coder, x_medians_[context].middle(), dx, only);
  x_medians_[context].add(dx);
  now.x = wrapped_sum(last_.x, dx);
  dy_.code(coder, y_medians_[context].middle(), dy, k_context(dx_.k(), kLargestYContext, only));
  y_medians_[context].add(dy);
  now.y = wrapped_sum(last_.y, dy);
  std::int32_t& height = last_heights_[return_level(n, r)];
  z_.code(coder, height, now.z, k_context((dx_.k() + dy_.k()) / 2, kLargestZContext, only));
  height = now.z;
  last_ = now;
}

}  // namespace lacuna::io::laz
