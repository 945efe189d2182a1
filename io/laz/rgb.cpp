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
  // A byte; `change` is how far those of the channels before changed.
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

std::uint16_t NirModels::decode(ArithmeticDecoder& decoder, std::uint16_t last) {
  const unsigned changed = decoder.symbol(changed_);
  unsigned low_byte = last & 255, high_byte = last >> 8;
  if (changed & 1) low_byte = (low_byte + decoder.symbol(bytes_[0])) & 255;
  if (changed & 2) high_byte = (high_byte + decoder.symbol(bytes_[1])) & 255;
  return static_cast<std::uint16_t>(high_byte << 8 | low_byte);
}

}  // namespace lacuna::io::laz
