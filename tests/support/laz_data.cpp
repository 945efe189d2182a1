// SPDX-License-Identifier: Apache-2.0
#include "tests/support/laz_data.hpp"

#include "io/files/little_endian.hpp"
#include "io/laz/laz_encoder.hpp"

namespace lacuna::test {
using namespace io;

laz::Layout laz_layout(int point_format, std::uint16_t extra_bytes, std::uint32_t chunk_points,
                       std::uint16_t version) {
  laz::Layout layout = laz::layout_of(point_format, extra_bytes);
  layout.chunk_points = chunk_points;
  for (laz::Item& item : layout.items) {
    if (item.type != laz::item_type::kWavepacket13) item.version = version;
  }
  return layout;
}

LazBytes laz_chunk(const laz::Layout& layout, std::span<const std::byte> records) {
  return laz::encode_chunk(layout, records);
}

LazBytes laz_point_data(const laz::Layout& layout, std::span<const std::byte> records,
                        std::span<const std::uint64_t> chunk_points, std::uint64_t offset) {
  LazBytes data(8);
  std::vector<laz::Chunk> chunks;
  for (const std::uint64_t points : chunk_points) {
    const LazBytes chunk = laz_chunk(layout, records.first(points * layout.record_bytes()));
    records = records.subspan(points * layout.record_bytes());
    chunks.push_back({offset + data.size(), chunk.size(), points});
    data.insert(data.end(), chunk.begin(), chunk.end());
  }
  store(data.data(), offset + data.size());
  const LazBytes table = laz::encode_chunk_table(layout, chunks);
  data.insert(data.end(), table.begin(), table.end());
  return data;
}

}  // namespace lacuna::test
