// SPDX-License-Identifier: Apache-2.0
#include "io/read/laz/laz_encoder.hpp"

#include "io/read/laz/layered.hpp"
#include "io/read/laz/pointwise.hpp"

#include <algorithm>
#include <cassert>

namespace lacuna::io::laz {

Layout layout_of(int point_format, std::uint16_t extra_bytes) {
  constexpr std::size_t kChunkPoints = 50'000;
  using namespace item_type;
  Layout layout{};
  if (point_format <= 5) {
    layout.compressor = compressor::kPointwiseChunked;
    layout.items.push_back({kPoint10, 20, 2});
    if (point_format != 0 && point_format != 2) layout.items.push_back({kGpsTime11, 8, 2});
    if (point_format == 2 || point_format == 3 || point_format == 5) layout.items.push_back({kRgb12, 6, 2});
    if (point_format >= 4) layout.items.push_back({kWavepacket13, 29, 1});
    if (extra_bytes > 0) layout.items.push_back({kByte, extra_bytes, 2});
  } else {
    layout.compressor = compressor::kLayeredChunked;
    layout.items.push_back({kPoint14, 30, 3});
    if (point_format == 7) layout.items.push_back({kRgb14, 6, 3});
    if (point_format == 8 || point_format == 10) layout.items.push_back({kRgbNir14, 8, 3});
    if (point_format >= 9) layout.items.push_back({kWavepacket14, 29, 3});
    if (extra_bytes > 0) layout.items.push_back({kByte14, extra_bytes, 3});
  }
  layout.chunk_points =
      static_cast<std::uint32_t>(std::min(kChunkPoints, kMostChunkBytes / layout.record_bytes()));
  return layout;
}

std::vector<std::byte> encode_chunk(const Layout& layout, std::span<const std::byte> records) {
  assert(!records.empty() && records.size() % layout.record_bytes() == 0);
  return layout.compressor == compressor::kLayeredChunked ? layered_chunk(layout, records)
                                                          : pointwise_chunk(layout, records);
}

std::uint64_t encoder_bytes(const Layout& layout) {
  return decoder_bytes(layout);  // the models are the same
}

}  // namespace lacuna::io::laz
