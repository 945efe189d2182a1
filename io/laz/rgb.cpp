// SPDX-License-Identifier: Apache-2.0
#include "io/laz/rgb.hpp"

#include <algorithm>

namespace lacuna::io::laz {
namespace {

// Bit 6 of the symbol that says which bytes changed: green and blue are not both equal to red.
constexpr unsigned kColoured = 1u << 6;

int low(std::uint16_t value) {
  return value & 255;
}
int high(std::uint16_t value) {
  return value >> 8;
}

}  // namespace

Rgb RgbModels::decode(ArithmeticDecoder& decoder, const Rgb& last) {
  const unsigned changed = decoder.symbol(changed_);
  // Codes a byte; `change` is how far the bytes of the channels before changed.
  const auto byte = [&](unsigned index, int last_byte, int change) {
    if (!(changed & 1u << index)) return last_byte;
    const int predicted = std::clamp(last_byte + change, 0, 255);
    return (predicted + static_cast<int>(decoder.symbol(bytes_[index]))) & 255;
  };
  const auto value = [](int low_byte, int high_byte) {
    return static_cast<std::uint16_t>(high_byte << 8 | low_byte);
  };

  const int red_low = byte(0, low(last[0]), 0);
  const int red_high = byte(1, high(last[0]), 0);
  const std::uint16_t red = value(red_low, red_high);
  if (!(changed & kColoured)) return {red, red, red};

  int change = red_low - low(last[0]);
  const int green_low = byte(2, low(last[1]), change);
  change = (change + green_low - low(last[1])) / 2;
  const int blue_low = byte(4, low(last[2]), change);

  change = red_high - high(last[0]);
  const int green_high = byte(3, high(last[1]), change);
  change = (change + green_high - high(last[1])) / 2;
  const int blue_high = byte(5, high(last[2]), change);
  return {red, value(green_low, green_high), value(blue_low, blue_high)};
}

void RgbModels::encode(ArithmeticEncoder& encoder, const Rgb& last, const Rgb& now) {
  unsigned changed = now[0] != now[1] || now[0] != now[2] ? kColoured : 0;
  for (unsigned channel = 0; channel < 3; ++channel) {
    if (low(now[channel]) != low(last[channel])) changed |= 1u << (2 * channel);
    if (high(now[channel]) != high(last[channel])) changed |= 2u << (2 * channel);
  }
  encoder.symbol(changed_, changed);
  const auto byte = [&](unsigned index, int last_byte, int change, int now_byte) {
    if (!(changed & 1u << index)) return;
    const int predicted = std::clamp(last_byte + change, 0, 255);
    encoder.symbol(bytes_[index], static_cast<unsigned>(now_byte - predicted) & 255);
  };

  byte(0, low(last[0]), 0, low(now[0]));
  byte(1, high(last[0]), 0, high(now[0]));
  if (!(changed & kColoured)) return;

  int change = low(now[0]) - low(last[0]);
  byte(2, low(last[1]), change, low(now[1]));
  change = (change + low(now[1]) - low(last[1])) / 2;
  byte(4, low(last[2]), change, low(now[2]));

  change = high(now[0]) - high(last[0]);
  byte(3, high(last[1]), change, high(now[1]));
  change = (change + high(now[1]) - high(last[1])) / 2;
  byte(5, high(last[2]), change, high(now[2]));
}

std::uint16_t NirModels::decode(ArithmeticDecoder& decoder, std::uint16_t last) {
  const unsigned changed = decoder.symbol(changed_);
  unsigned low_byte = last & 255, high_byte = last >> 8;
  if (changed & 1) low_byte = (low_byte + decoder.symbol(bytes_[0])) & 255;
  if (changed & 2) high_byte = (high_byte + decoder.symbol(bytes_[1])) & 255;
  return static_cast<std::uint16_t>(high_byte << 8 | low_byte);
}

void NirModels::encode(ArithmeticEncoder& encoder, std::uint16_t last, std::uint16_t now) {
  const unsigned low_change = static_cast<unsigned>(low(now) - low(last)) & 255,
                 high_change = static_cast<unsigned>(high(now) - high(last)) & 255;
  encoder.symbol(changed_, (low_change > 0 ? 1u : 0u) | (high_change > 0 ? 2u : 0u));
  if (low_change > 0) encoder.symbol(bytes_[0], low_change);
  if (high_change > 0) encoder.symbol(bytes_[1], high_change);
}

}  // namespace lacuna::io::laz
