// SPDX-License-Identifier: Apache-2.0
#include "io/read/laz/laz.hpp"

#include "io/read/files/number.hpp"
#include "io/read/laz/arithmetic_coder.hpp"
#include "io/read/laz/items.hpp"
#include "io/read/laz/predicted_values.hpp"

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

namespace lacuna::io::laz {

std::vector<std::byte> read_all(const ChunkBytes& bytes, std::uint64_t begin, std::uint64_t end) {
  if (end > bytes.size()) throw Corrupt("a chunk of compressed points is cut");
  std::vector<std::byte> all, buffer;
  all.reserve(end - begin);
  while (begin < end) {
    const std::span<const std::byte> piece = bytes.read(begin, end, buffer);
    all.insert(all.end(), piece.begin(), piece.end());
    begin += piece.size();
  }
  return all;
}

void ArithmeticDecoder::read_more() {
  if (left_at_ == left_end_) throw Corrupt("the compressed points end too early");
  const std::span<const std::byte> piece = bytes_->read(left_at_, left_end_, buffer_);
  next_ = piece.data();
  end_ = next_ + piece.size();
  left_at_ += piece.size();
}

// Adds one to the number that the bytes are. It does not grow longer, since the interval stays within 0 to 1.
void ArithmeticEncoder::carry() {
  auto byte = bytes_.rbegin();
  for (; *byte == std::byte{0xff}; ++byte) *byte = std::byte{0};
  *byte = static_cast<std::byte>(std::to_integer<unsigned>(*byte) + 1);
}

std::vector<std::byte> ArithmeticEncoder::finish() {
  // Few bytes that stand for a place in the interval, and zeros, so that a decoder may read ahead.
  const bool is_long = length_ > 2 * kMinLength;
  if (is_long) {
    narrow(kMinLength, kMinLength / 2);
  } else {
    narrow(kMinLength / 2, kMinLength / 512);
  }
  bytes_.insert(bytes_.end(), is_long ? 3 : 2, std::byte{0});
  return std::move(bytes_);
}

namespace {

// The record of the LAS header that says how points are compressed (LAZ, "LASzip VLR").

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
  if (layout.compressor != compressor::kPointwiseChunked &&
      layout.compressor != compressor::kLayeredChunked) {
    throw Corrupt("compressor " + std::to_string(layout.compressor) +
                  " is not supported (2 and 3 are); `laszip` decompresses files from before 2011");
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
      if (before.version != item.version && !is_packet)
        throw Corrupt(described(item) + " has not the version of the items before");
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

namespace {

// The table of where chunks begin (LAZ, "Chunk table").

// Version and number of chunks, 4 bytes each; then the chunks' sizes, compressed.
constexpr std::size_t kHeaderBytes = 8;
constexpr unsigned kPointsContext = 0, kBytesContext = 1;

std::uint32_t chunk_count(std::span<const std::byte> table) {
  if (table.size() < kHeaderBytes) throw Corrupt("the chunk table is cut");
  const auto version = load<std::uint32_t>(table.data());
  if (version != 0) {
    throw Corrupt("the chunk table has version " + std::to_string(version) +
                  ", not 0: its offset may be wrong");
  }
  return load<std::uint32_t>(table.data() + 4);
}

}  // namespace

std::uint64_t chunk_table_bytes(std::span<const std::byte> first_8_bytes) {
  // A number of 32 bits takes at most 15 bits for its k, 15 for its first bits and 23 for the others. With
  // what an encoder adds at the end, 8 bytes for each number are enough.
  return kHeaderBytes + 16 + 2 * 8 * std::uint64_t{chunk_count(first_8_bytes)};
}

std::vector<Chunk> read_chunk_table(const Layout& layout, std::span<const std::byte> table,
                                    std::uint64_t first_chunk, std::uint64_t table_offset,
                                    std::uint64_t points) {
  const std::uint64_t count = chunk_count(table);
  if (table_offset < first_chunk) throw Corrupt("the chunk table lies before the first chunk");
  // Each chunk has a point at least, and the first one is not compressed.
  const std::uint64_t most = std::min((table_offset - first_chunk) / layout.record_bytes(), points);
  if (count > most) {
    throw Corrupt("the chunk table has " + std::to_string(count) + " chunks, more than the " +
                  std::to_string(most) + " that the file can hold");
  }

  std::vector<Chunk> chunks;
  if (count > 0) {
    const ChunkInMemory sizes(table.subspan(kHeaderBytes));
    ArithmeticDecoder decoder(sizes, 0, sizes.size());
    const auto numbers = std::make_unique<IntegerCoder<32, 2>>();
    const bool variable = layout.chunk_points == kVariableChunks;
    std::uint64_t offset = first_chunk, left = points;
    std::uint32_t chunk_points = 0, bytes = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      if (variable) chunk_points = numbers->decode(decoder, chunk_points, kPointsContext);
      bytes = numbers->decode(decoder, bytes, kBytesContext);
      const std::uint64_t has = variable ? chunk_points : std::min<std::uint64_t>(layout.chunk_points, left);
      const std::string chunk = "chunk " + std::to_string(i + 1) + " of " + std::to_string(count);
      if (bytes > table_offset - offset) throw Corrupt(chunk + " reaches beyond the chunk table");
      if (has == 0 || has > left) throw Corrupt(chunk + " does not fit the number of points of the file");
      if (bytes < layout.record_bytes() || has > kMostPointsInAByte * bytes) {
        throw Corrupt(chunk + " has " + std::to_string(has) + " points in only " + std::to_string(bytes) +
                      " bytes");
      }
      chunks.push_back({offset, bytes, has});
      offset += bytes;
      left -= has;
    }
    if (left == 0) return chunks;
  }
  if (points == 0) return chunks;
  std::uint64_t held = 0;
  for (const Chunk& chunk : chunks) held += chunk.points;
  throw Corrupt("the chunks have " + std::to_string(held) + " points, the file " + std::to_string(points));
}

std::vector<std::byte> encode_chunk_table(const Layout& layout, std::span<const Chunk> chunks) {
  std::vector<std::byte> table(kHeaderBytes);
  store(table.data() + 4, static_cast<std::uint32_t>(chunks.size()));  // behind version 0
  if (chunks.empty()) return table;
  ArithmeticEncoder encoder;
  const auto numbers = std::make_unique<IntegerCoder<32, 2>>();
  const bool variable = layout.chunk_points == kVariableChunks;
  std::uint32_t last_points = 0, last_bytes = 0;
  for (const Chunk& chunk : chunks) {
    const auto points = static_cast<std::uint32_t>(chunk.points),
               bytes = static_cast<std::uint32_t>(chunk.bytes);
    if (variable) numbers->encode(encoder, std::exchange(last_points, points), points, kPointsContext);
    numbers->encode(encoder, std::exchange(last_bytes, bytes), bytes, kBytesContext);
  }
  const std::vector<std::byte> sizes = encoder.finish();
  table.insert(table.end(), sizes.begin(), sizes.end());
  return table;
}

ChunkDecoder::ChunkDecoder(const Layout& layout, const ChunkBytes& bytes) : layout_(layout), bytes_(bytes) {}

ChunkDecoder::~ChunkDecoder() = default;

void ChunkDecoder::decode(std::span<std::byte> records) {
  if (!records.empty() && first_.empty()) {
    // The first point is not compressed.
    const std::size_t record_bytes = layout_.record_bytes();
    if (bytes_.size() < record_bytes)
      throw Corrupt("a chunk of compressed points is shorter than its first point");
    first_ = read_all(bytes_, 0, record_bytes);
    std::copy(first_.begin(), first_.end(), records.begin());
    records = records.subspan(record_bytes);
  }
  if (records.empty()) return;
  begin_rest();
  rest_->decode(records);
}

void ChunkDecoder::begin_rest() {
  if (rest_) return;
  rest_ = layout_.compressor == compressor::kLayeredChunked ? layered_decoder(layout_, bytes_, first_)
                                                            : pointwise_decoder(layout_, bytes_, first_);
}

bool ChunkDecoder::has_other_than(std::uint64_t points) {
  if (bytes_.size() == first_.size()) return false;  // a point alone
  begin_rest();
  return rest_->has_other_than(points);
}

std::uint64_t decoder_bytes(const Layout& layout) {
  // Models of all values of three fields, in four scanner channels.
  constexpr std::uint64_t kPoints = std::uint64_t{2} << 20;
  // A model for each scanner channel and one to copy, and the decoder of the layer.
  constexpr std::uint64_t kLayeredByte = 5 * sizeof(SymbolModel<256>) + 128;
  constexpr std::uint64_t kPointwiseByte = sizeof(SymbolModel<256>);
  std::uint64_t bytes = kPoints;
  for (const Item& item : layout.items) {
    if (item.type == item_type::kByte) bytes += item.size * kPointwiseByte;
    if (item.type == item_type::kByte14) bytes += item.size * kLayeredByte;
  }
  return bytes;
}

std::size_t stream_count(const Layout& layout) {
  return layout.compressor == compressor::kLayeredChunked ? layer_count(layout) : 1;
}

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
