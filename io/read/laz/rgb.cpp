// SPDX-License-Identifier: Apache-2.0
#include "io/read/laz/rgb.hpp"

#include <algorithm>
#include <span>

namespace lacuna::io::laz {
namespace {

// Bit 6 of the symbol that says which bytes changed: green and blue are not both equal to red.
constexpr unsigned kColoured = 1u << 6;

// Returns the bits of the bytes that differ, from the low one of the first value on.
unsigned changed_bytes(std::span<const std::uint16_t> last, std::span<const std::uint16_t> now) {
  unsigned changed = 0;
  for (unsigned i = 0; i < now.size(); ++i) {
    const unsigned different = last[i] ^ now[i];
    if (different & 255) changed |= 1u << (2 * i);
    if (different >> 8) changed |= 2u << (2 * i);
  }
  return changed;
}

// Codes the byte of `now` at a bit, 0 or 8, as its difference to a predicted one.
template <class Coder>
void code_byte(Coder& coder, SymbolModel<256>& model, unsigned at, int predicted, std::uint16_t& now) {
  auto difference = static_cast<std::uint8_t>((now >> at) - predicted);
  coder.code(model, difference);
  const int byte = (predicted + difference) & 255;
  now = static_cast<std::uint16_t>((now & ~(255 << at)) | byte << at);
}

}  // namespace

template <class Coder>
void RgbModels::code(Coder& coder, const Rgb& last, Rgb& now) {
  unsigned changed = 0;
  if constexpr (Coder::kEncodes)
    changed = changed_bytes(last, now) | (now[0] != now[1] || now[0] != now[2] ? kColoured : 0);
  coder.code(changed_, changed);
  // Codes a byte. The bytes of the channels before changed by `change`. Returns how far this one changed.
  const auto byte = [&](unsigned index, int change) {
    const unsigned channel = index / 2, at = index % 2 * 8;
    const int before = last[channel] >> at & 255;
    if (changed & 1u << index)
      code_byte(coder, bytes_[index], at, std::clamp(before + change, 0, 255), now[channel]);
    return (now[channel] >> at & 255) - before;
  };
  const int red_low = byte(0, 0), red_high = byte(1, 0);
  if (!(changed & kColoured)) {
    now[1] = now[2] = now[0];
    return;
  }
  byte(4, (red_low + byte(2, red_low)) / 2);
  byte(5, (red_high + byte(3, red_high)) / 2);
}

template <class Coder>
void NirModels::code(Coder& coder, std::uint16_t last, std::uint16_t& now) {
  unsigned changed = 0;
  if constexpr (Coder::kEncodes) changed = changed_bytes(std::span(&last, 1), std::span(&now, 1));
  coder.code(changed_, changed);
  if (changed & 1) code_byte(coder, bytes_[0], 0, last & 255, now);
  if (changed & 2) code_byte(coder, bytes_[1], 8, last >> 8, now);
}

template void RgbModels::code(ArithmeticDecoder&, const Rgb&, Rgb&);
template void RgbModels::code(ArithmeticEncoder&, const Rgb&, Rgb&);
template void NirModels::code(ArithmeticDecoder&, std::uint16_t, std::uint16_t&);
template void NirModels::code(ArithmeticEncoder&, std::uint16_t, std::uint16_t&);

}  // namespace lacuna::io::laz
