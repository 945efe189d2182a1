// SPDX-License-Identifier: Apache-2.0
#include "tests/support/laz_data.hpp"

#include "io/read/files/number.hpp"
#include "io/read/laz/laz.hpp"

namespace lacuna::test {
using namespace io;

laz::Layout laz_layout(int point_format, std::uint16_t extra_bytes, std::uint32_t chunk_points,
                       std::uint16_t version) {
  laz::Layout layout = laz::layout_of(point_format, extra_bytes);
  layout.chunk_points = chunk_points;
  for (laz::Item& item : layout.items)
    if (item.type != laz::item_type::kWavepacket13) item.version = version;
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

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string laz_head(LasFile las, const laz::Layout& layout) {
  las.records.push_back(las_record("laszip encoded", 22204, text_of(laz::layout_record(layout))));
  std::string bytes = las.bytes();
  bytes.resize(bytes.size() - las.points.size() * las.points[0].size());
  put(bytes, 104, static_cast<std::uint8_t>(las.format | 0x80));
  return bytes;
}

std::string laz_points(const laz::Layout& layout, const std::string& records,
                       const std::vector<std::uint64_t>& chunk_points, std::size_t offset) {
  const std::span bytes = std::as_bytes(std::span(records));
  return text_of(layout.compressor == laz::compressor::kPointwise
                     ? laz_chunk(layout, bytes)
                     : laz_point_data(layout, bytes, chunk_points, offset));
}

std::string laz_file(const LasFile& las, const laz::Layout& layout,
                     const std::vector<std::uint64_t>& chunk_points) {
  std::string head = laz_head(las, layout), points;
  for (const std::string& point : las.points) points += point;
  return head + laz_points(layout, points, chunk_points, head.size());
}

}  // namespace lacuna::test
