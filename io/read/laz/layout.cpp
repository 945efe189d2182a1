// SPDX-License-Identifier: Apache-2.0
// The record of the LAS header that says how points are compressed (LAZ, "LASzip VLR").
#include "io/read/files/little_endian.hpp"
#include "io/read/laz/laz.hpp"
#include "io/read/laz/laz_encoder.hpp"

#include <string>

namespace lacuna::io::laz {
namespace {

constexpr std::size_t kCompressorAt = 0, kCoderAt = 2, kVersionAt = 4, kChunkPointsAt = 12,
                      kSpecialCountAt = 16, kSpecialOffsetAt = 24, kItemCountAt = 32, kItemsAt = 34;
constexpr std::size_t kItemBytes = 6;

enum class Order { kPointwise, kLayered };

struct KnownItem {
  std::uint16_t type;
  const char* name;
  std::uint16_t size;  // 0: any but 0
  Order order;
};

// The items of each order as they follow each other in a record.
constexpr KnownItem kKnownItems[] = {
    {item_type::kPoint10, "POINT10", 20, Order::kPointwise},
    {item_type::kGpsTime11, "GPSTIME11", 8, Order::kPointwise},
    {item_type::kRgb12, "RGB12", 6, Order::kPointwise},
    {item_type::kWavepacket13, "WAVEPACKET13", 29, Order::kPointwise},
    {item_type::kByte, "BYTE", 0, Order::kPointwise},
    {item_type::kPoint14, "POINT14", 30, Order::kLayered},
    {item_type::kRgb14, "RGB14", 6, Order::kLayered},
    {item_type::kRgbNir14, "RGBNIR14", 8, Order::kLayered},
    {item_type::kWavepacket14, "WAVEPACKET14", 29, Order::kLayered},
    {item_type::kByte14, "BYTE14", 0, Order::kLayered},
};

const KnownItem& known(const Item& item) {
  for (const KnownItem& candidate : kKnownItems) {
    if (candidate.type == item.type) return candidate;
  }
  throw Corrupt("item type " + std::to_string(item.type) + " of the compressed points is not known");
}

std::string described(const Item& item) {
  return std::string("item ") + known(item).name + " of version " + std::to_string(item.version) + " and " +
         std::to_string(item.size) + " bytes";
}

void check(const Item& item, Order order) {
  const KnownItem& expected = known(item);
  const auto fail = [&](const std::string& why) { throw Corrupt(described(item) + " " + why); };
  if (expected.size ? item.size != expected.size : item.size == 0) fail("has a wrong size");
  if (expected.order != order) fail("does not belong to the compressor of the file");
  if (item.type == item_type::kWavepacket13 && item.version == 1) return;
  if (order == Order::kPointwise && item.version != 2)
    fail("is not supported (version 2 is); `laszip` decompresses files from before 2011");
  if (order == Order::kLayered && item.version != 3 && item.version != 4)
    fail("is not supported (version 3 and 4 are)");
}

}  // namespace

std::size_t Layout::record_bytes() const {
  std::size_t bytes = 0;
  for (const Item& item : items) bytes += item.size;
  return bytes;
}

Layout parse_layout(std::span<const std::byte> record) {
  if (record.size() < kItemsAt) {
    throw Corrupt("the record \"laszip encoded\" has " + std::to_string(record.size()) +
                  " bytes, not at least " + std::to_string(kItemsAt));
  }
  Layout layout{.compressor = load<std::uint16_t>(&record[kCompressorAt]),
                .chunk_points = load<std::uint32_t>(&record[kChunkPointsAt]),
                .items = {}};
  if (layout.compressor < compressor::kPointwise || layout.compressor > compressor::kLayeredChunked) {
    throw Corrupt("compressor " + std::to_string(layout.compressor) + " is not supported (1, 2 and 3 are)");
  }
  const auto coder = load<std::uint16_t>(&record[kCoderAt]);
  if (coder != 0) throw Corrupt("entropy coder " + std::to_string(coder) + " is not supported (0 is)");
  if (layout.chunk_points == 0)
    layout.chunk_points = kVariableChunks;  // as LASzip takes it; LAStools writes 0

  const std::size_t count = load<std::uint16_t>(&record[kItemCountAt]);
  if (count == 0 || kItemsAt + count * kItemBytes > record.size()) {
    throw Corrupt("the record \"laszip encoded\" of " + std::to_string(record.size()) +
                  " bytes does not hold its " + std::to_string(count) + " items");
  }
  const Order order = layout.compressor == compressor::kLayeredChunked ? Order::kLayered : Order::kPointwise;
  for (std::size_t i = 0; i < count; ++i) {
    const std::byte* at = &record[kItemsAt + i * kItemBytes];
    const Item item{load<std::uint16_t>(at), load<std::uint16_t>(at + 2), load<std::uint16_t>(at + 4)};
    check(item, order);
    const std::uint16_t point = order == Order::kLayered ? item_type::kPoint14 : item_type::kPoint10;
    if ((i == 0) != (item.type == point)) throw Corrupt(described(item) + " is in a wrong place");
    if (i > 0) {
      const Item& before = layout.items.back();
      const bool both_rgb = before.type == item_type::kRgb14 && item.type == item_type::kRgbNir14;
      if (&known(before) >= &known(item) || both_rgb) throw Corrupt(described(item) + " is in a wrong place");
      const bool is_packet = before.type == item_type::kWavepacket13 || item.type == item_type::kWavepacket13;
      if (before.version != item.version && !is_packet) {
        throw Corrupt(described(item) + " has not the version of the items before");
      }
    }
    layout.items.push_back(item);
  }
  return layout;
}

std::vector<std::byte> layout_record(const Layout& layout) {
  std::vector<std::byte> record(kItemsAt + kItemBytes * layout.items.size());
  store(&record[kCompressorAt], layout.compressor);
  // The version of LASzip that such points came with, 3.4 revision 3; readers do not depend on it.
  store(&record[kVersionAt], std::uint8_t{3});
  store(&record[kVersionAt + 1], std::uint8_t{4});
  store(&record[kVersionAt + 2], std::uint16_t{3});
  store(&record[kChunkPointsAt], layout.chunk_points);
  store(&record[kSpecialCountAt], std::int64_t{-1});  // no special extended records
  store(&record[kSpecialOffsetAt], std::int64_t{-1});
  store(&record[kItemCountAt], static_cast<std::uint16_t>(layout.items.size()));
  std::byte* at = &record[kItemsAt];
  for (const Item& item : layout.items) {
    for (const std::uint16_t number : {item.type, item.size, item.version}) {
      store(at, number);
      at += sizeof number;
    }
  }
  return record;
}

}  // namespace lacuna::io::laz
