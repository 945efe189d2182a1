// SPDX-License-Identifier: Apache-2.0
// Code that the decoders and the encoders of RGB14, RGBNIR14 and BYTE14 share.
#pragma once

#include "io/laz/channel_values.hpp"
#include "io/laz/laz.hpp"
#include "io/laz/rgb.hpp"
#include "io/laz/symbol_model.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace lacuna::io::laz {

// RGB14 has no `nir`: it is 0.
struct Colour {
  Rgb rgb;
  std::uint16_t nir;
};
inline std::size_t colour_bytes(bool has_nir) {
  return has_nir ? sizeof(Colour) : sizeof(Rgb);
}
inline Colour read_colour(bool has_nir, const std::byte* item) {
  Colour colour{};
  std::memcpy(&colour, item, colour_bytes(has_nir));
  return colour;
}

struct ColourModels {
  RgbModels rgb;
  NirModels nir;
};
using ColourChannels = ChannelValues<Colour, ColourModels>;

using ByteChannels = ChannelValues<std::vector<std::byte>, std::vector<SymbolModel<256>>>;
inline ByteChannels byte_channels(ChannelRule rule, unsigned channel, std::span<const std::byte> first) {
  return {rule, channel, std::vector<std::byte>(first.begin(), first.end()),
          std::vector<SymbolModel<256>>(first.size())};
}

inline ChannelRule channel_rule(const Layout& layout) {
  return layout.items[0].version == 3 ? ChannelRule::kVersion3 : ChannelRule::kVersion4;
}

}  // namespace lacuna::io::laz
