// SPDX-License-Identifier: Apache-2.0
#include "io/laz/version1.hpp"

#include "io/files/little_endian.hpp"
#include "io/laz/wrapped.hpp"

#include <algorithm>

namespace lacuna::io::laz::version1 {
namespace {

std::int32_t middle(const std::array<std::int32_t, 3>& values) {
  return std::max(std::min(values[0], values[1]), std::min(std::max(values[0], values[1]), values[2]));
}

// Bits of the symbol that says which fields differ from the last point's; not in the order of version 2.
constexpr unsigned kPointSource = 1, kUserData = 2, kScanAngle = 4, kClassification = 8, kReturns = 16,
                   kIntensity = 32;

constexpr unsigned kLargestKContext = 19;

}  // namespace

Point10::Point10(const std::byte* first) {
  static_assert(sizeof last_ == 20);
  std::memcpy(&last_, first, sizeof last_);
}

void Point10::decode(ArithmeticDecoder& decoder, std::byte* item) {
  const std::int32_t dx = dx_.decode_signed(decoder, middle(last_dx_));
  const std::int32_t dy = dy_.decode_signed(decoder, middle(last_dy_), std::min(dx_.k(), kLargestKContext));
  const unsigned k = (dx_.k() + dy_.k()) / 2;
  last_.x = wrapped_sum(last_.x, dx);
  last_.y = wrapped_sum(last_.y, dy);
  last_.z = z_.decode_signed(decoder, last_.z, std::min(k, kLargestKContext));
  last_dx_[next_difference_] = dx;
  last_dy_[next_difference_] = dy;
  next_difference_ = (next_difference_ + 1) % last_dx_.size();

  const unsigned changed = decoder.symbol(changed_);
  if (changed & kIntensity) {
    last_.intensity = static_cast<std::uint16_t>(intensity_.decode(decoder, last_.intensity));
  }
  if (changed & kReturns) {
    last_.returns = static_cast<std::uint8_t>(decoder.symbol(returns_[last_.returns]));
  }
  if (changed & kClassification) {
    last_.classification = static_cast<std::uint8_t>(decoder.symbol(classification_[last_.classification]));
  }
  if (changed & kScanAngle) {
    last_.scan_angle = static_cast<std::uint8_t>(scan_angle_.decode(decoder, last_.scan_angle, k < 3));
  }
  if (changed & kUserData) {
    last_.user_data = static_cast<std::uint8_t>(decoder.symbol(user_data_[last_.user_data]));
  }
  if (changed & kPointSource) {
    last_.point_source = static_cast<std::uint16_t>(point_source_.decode(decoder, last_.point_source));
  }
  std::memcpy(item, &last_, sizeof last_);
}

GpsTime11::GpsTime11(const std::byte* first) : last_(load<std::uint64_t>(first)) {}

void GpsTime11::decode(ArithmeticDecoder& decoder, std::byte* item) {
  if (difference_ == 0) {
    const unsigned symbol = decoder.symbol(first_);
    if (symbol == 1) {
      difference_ = integers_.decode_signed(decoder, 0, 0);
      add(difference_);
    } else if (symbol == 2) {
      last_ = decoder.bits64();
    }
  } else {
    decode_next(decoder);
  }
  store(item, last_);
}

void GpsTime11::decode_next(ArithmeticDecoder& decoder) {
  const unsigned factor = decoder.symbol(next_);
  if (factor == kFactors) last_ = decoder.bits64();
  if (factor >= kFactors) return;

  // A factor of 0 stands for differences that are much smaller than the last one.
  const std::uint32_t prediction = factor == 0 ? static_cast<std::uint32_t>(difference_ / 4)
                                               : factor * static_cast<std::uint32_t>(difference_);
  const unsigned context = factor == 0 ? 2 : factor == 1 ? 1 : factor < 10 ? 3 : factor < 50 ? 4 : 5;
  const auto difference = static_cast<std::int32_t>(integers_.decode(decoder, prediction, context));
  if (factor == 1) {
    difference_ = difference;
    extremes_ = 0;
  } else if ((factor == 0 || factor == kFactors - 1) && ++extremes_ > 3) {
    difference_ = difference;
    extremes_ = 0;
  }
  add(difference);
}

void GpsTime11::add(std::int32_t difference) {
  last_ += static_cast<std::uint64_t>(std::int64_t{difference});
}

Rgb12::Rgb12(const std::byte* first) {
  std::memcpy(last_.data(), first, last_.size());
}

void Rgb12::decode(ArithmeticDecoder& decoder, std::byte* item) {
  const unsigned changed = decoder.symbol(changed_);
  for (unsigned i = 0; i < last_.size(); ++i) {
    if (changed & 1u << i) last_[i] = static_cast<std::uint8_t>(bytes_.decode(decoder, last_[i], i));
  }
  std::memcpy(item, last_.data(), last_.size());
}

ExtraBytes::ExtraBytes(const std::byte* first, std::size_t count) : last_(first, first + count), ks_(count) {}

void ExtraBytes::decode(ArithmeticDecoder& decoder, std::byte* item) {
  for (std::size_t i = 0; i < last_.size(); ++i) {
    last_[i] =
        static_cast<std::byte>(integers_.decode(decoder, std::to_integer<std::uint32_t>(last_[i]), ks_[i]));
  }
  std::copy(last_.begin(), last_.end(), item);
}

}  // namespace lacuna::io::laz::version1
