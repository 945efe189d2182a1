// SPDX-License-Identifier: Apache-2.0
#include "io/read/laz/laz.hpp"

#include "io/read/files/number.hpp"
#include "tests/io/broken_files.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::test {
namespace {

using laz::Chunk;
using laz::Corrupt;
using laz::Layout;

struct Case {
  int point_format;
  std::uint16_t extra_bytes, version;
};
const Case kCases[] = {{0, 0, 2}, {1, 0, 2}, {2, 0, 2}, {3, 0, 2}, {1, 2, 2}, {3, 5, 2}, {6, 0, 3}, {7, 0, 3},
                       {8, 0, 3}, {6, 3, 3}, {7, 1, 3}, {8, 2, 3}, {6, 2, 4}, {7, 2, 4}, {8, 1, 4}};

// With wave packets. No other encoder has made chunks of them here.
const Case kPacketCases[] = {{4, 0, 2}, {5, 3, 2}, {9, 0, 3}, {10, 2, 3}, {9, 1, 4}};

std::vector<Case> all_cases() {
  std::vector<Case> all(std::begin(kCases), std::end(kCases));
  all.insert(all.end(), std::begin(kPacketCases), std::end(kPacketCases));
  return all;
}

std::string name(const Case& c) {
  return "point format " + std::to_string(c.point_format) + ", version " + std::to_string(c.version) + ", " +
         std::to_string(c.extra_bytes) + " extra bytes";
}

Layout layout_of(const Case& c, std::uint32_t chunk_points = laz::kVariableChunks) {
  return laz_layout(c.point_format, c.extra_bytes, chunk_points, c.version);
}

using Random = std::mt19937;

unsigned below(Random& random, unsigned end) {
  return static_cast<unsigned>(random() % end);
}

void put_time(Random& random, std::byte* at, std::uint64_t& time) {
  // Steps as of pulses, now and then a longer one, another flight line or a leap.
  const unsigned kind = below(random, 40);
  if (kind < 12) return store(at, time);
  if (kind < 30) time += 1000 * (1 + below(random, 3));
  if (kind == 30) time += 1000 * below(random, 700);
  if (kind == 31) time -= 1000 * below(random, 20);
  if (kind == 32) time += std::uint64_t{1} << 40;
  if (kind == 33) time -= std::uint64_t{1} << 40;
  if (kind == 34) time += random();
  store(at, time);
}

// Points along scan lines, with several returns, four scanner channels and colours that are alike.
LazBytes plausible_records(const Layout& layout, std::size_t points, Random& random) {
  const std::size_t size = layout.record_bytes();
  const bool layered = layout.compressor == laz::compressor::kLayeredChunked;
  LazBytes records(points * size);
  std::uint64_t time = 0x41d0000000000000;
  std::int32_t x = 500000, y = -200000, z = 1000;
  unsigned channel = below(random, 4), r = 1, n = 1;
  for (std::size_t i = 0; i < points; ++i) {
    std::byte* at = records.data() + i * size;
    const auto byte = [&](std::size_t index, unsigned value) { at[index] = static_cast<std::byte>(value); };
    if (i > 0) std::copy_n(at - size, size, at);
    x += static_cast<std::int32_t>(below(random, 200)) - 50;
    y += static_cast<std::int32_t>(below(random, 20)) - 10;
    z += static_cast<std::int32_t>(below(random, 50)) - 25;
    if (below(random, 60) == 0) x -= 100000;
    store(at, x);
    store(at + 4, y);
    store(at + 8, z);
    if (below(random, 3)) store(at + 12, static_cast<std::uint16_t>(below(random, 300)));
    if (++r > n) n = 1 + below(random, layered ? 15 : 5), r = 1;
    std::size_t end;
    if (layered) {
      if (below(random, 10) == 0) channel = below(random, 4);
      byte(14, r | n << 4);
      byte(15, below(random, 8) | channel << 4 | below(random, 4) << 6);
      byte(16, below(random, 4));
      if (below(random, 8) == 0) byte(17, below(random, 256));
      if (below(random, 8) == 0) store(at + 18, static_cast<std::int16_t>(below(random, 6000) - 3000));
      if (below(random, 20) == 0) store(at + 20, static_cast<std::uint16_t>(below(random, 5)));
      put_time(random, at + 22, time);
      end = 30;
    } else {
      byte(14, r | n << 3 | below(random, 4) << 6);
      byte(15, below(random, 4));
      byte(16, below(random, 40) - 20);
      if (below(random, 8) == 0) byte(17, below(random, 256));
      if (below(random, 20) == 0) store(at + 18, static_cast<std::uint16_t>(below(random, 5)));
      end = 20;
    }
    for (const laz::Item& item : layout.items)
      if (item.type == laz::item_type::kGpsTime11) put_time(random, at + 20, time), end += 8;
    for (; end < size; ++end)
      if (below(random, 3) == 0) byte(end, std::to_integer<unsigned>(at[end]) + below(random, 9));
  }
  return records;
}

LazBytes random_records(const Layout& layout, std::size_t points, Random& random) {
  LazBytes records(points * layout.record_bytes());
  for (std::byte& byte : records) byte = static_cast<std::byte>(random());
  return records;
}

// Plausible points, and steps of every size between them.
LazBytes leaping_records(const Layout& layout, std::size_t points, Random& random) {
  LazBytes records = plausible_records(layout, points, random);
  for (std::size_t at = 0; at < records.size(); at += layout.record_bytes()) {
    const unsigned shift = below(random, 32);
    for (std::size_t axis = 0; axis < 3; ++axis)
      store(&records[at + 4 * axis], static_cast<std::int32_t>(random()) >> shift);
  }
  return records;
}

void decode_chunk(const Layout& layout, std::span<const std::byte> chunk, std::span<std::byte> records) {
  const laz::ChunkInMemory bytes(chunk);
  laz::ChunkDecoder(layout, bytes).decode(records);
}

LazBytes decoded(const Layout& layout, const LazBytes& chunk, std::uint64_t points) {
  LazBytes records(points * layout.record_bytes());
  decode_chunk(layout, chunk, records);
  return records;
}

// Bytes that come a few at a time, into the reader's buffer.
class ChunkInPieces final : public laz::ChunkBytes {
 public:
  ChunkInPieces(const LazBytes& chunk, std::size_t piece) : chunk_(chunk), piece_(piece) {}
  std::uint64_t size() const override { return chunk_.size(); }
  std::span<const std::byte> read(std::uint64_t begin, std::uint64_t end,
                                  std::vector<std::byte>& buffer) const override {
    const auto all = std::span(chunk_).subspan(begin, std::min<std::uint64_t>(end - begin, piece_));
    buffer.assign(all.begin(), all.end());
    return buffer;
  }

 private:
  const LazBytes& chunk_;
  std::size_t piece_;
};

LazBytes bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::string message(const std::function<void()>& run) {
  return error_of<Corrupt>(run);
}

template <class T>
T number(const LazBytes& bytes, std::uint64_t at) {
  return load<T>(&bytes.at(at));
}

// Comparisons of records have double parentheses, lest Catch prints a failure of megabytes.

// All records of a LAZ file, by the header of LAS 1.2.
LazBytes records_of_file(const LazBytes& file) {
  const std::uint64_t points = number<std::uint32_t>(file, 107), data = number<std::uint32_t>(file, 96);
  std::uint64_t at = number<std::uint16_t>(file, 94);
  Layout layout{};
  for (unsigned record = number<std::uint32_t>(file, 100); record > 0; --record) {
    const auto id = number<std::uint16_t>(file, at + 18), length = number<std::uint16_t>(file, at + 20);
    if (id == 22204) layout = laz::parse_layout(std::span(file).subspan(at + 54, length));
    at += 54 + length;
  }
  const std::uint64_t table = number<std::uint64_t>(file, data);
  LazBytes records;
  for (const Chunk& chunk :
       laz::read_chunk_table(layout, std::span(file).subspan(table), data + 8, table, points)) {
    const std::size_t before = records.size();
    records.resize(before + chunk.points * layout.record_bytes());
    decode_chunk(layout, std::span(file).subspan(chunk.offset, chunk.bytes),
                 std::span(records).subspan(before));
  }
  return records;
}

// FNV-1a of 64 bits.
std::uint64_t digest(const LazBytes& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const std::byte byte : bytes) hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3;
  return hash;
}

}  // namespace

// Decoder and encoder share models and contexts, so that one mistake in these could hide from tests of both.
TEST_CASE("chunks have the bytes that an encoder of its own, written after the specification, had", "[laz]") {
  struct Expected {
    Case of;
    std::size_t bytes;
    std::uint64_t plausible, leaping, random;  // digests of the chunks
  };
  const Expected all[] = {
      {{0, 0, 2}, 31145, 0x8bebad9860765ae8, 0x15de636f99957a3c, 0x475ddcc8666b77d6},
      {{1, 0, 2}, 36113, 0xabfbd19168428694, 0xe49209f9efdd65b9, 0xaec1e07e4e767f7d},
      {{2, 0, 2}, 39427, 0xba6edb44215db2dc, 0x43b012b34605015b, 0x90da37b45028a085},
      {{3, 0, 2}, 44288, 0x0179e4d34de76fb4, 0x664c093f8ef9cc09, 0x357862787d353d94},
      {{1, 2, 2}, 39046, 0xf98d9d8dadec761e, 0xec4d7cd23555b31d, 0xa0cc6d94b516899e},
      {{3, 5, 2}, 51204, 0x167ff1bcd35e6f42, 0x58e296dbb54c6d69, 0x836dbeb9afaea5ed},
      {{6, 0, 3}, 45109, 0x44c1526c5c7c63a4, 0x651fee12b489fe69, 0x1ec476e66b8c2dd1},
      {{7, 0, 3}, 55335, 0x95056205aec07f62, 0x7bb668fe96753803, 0xf906c283874179fa},
      {{8, 0, 3}, 59025, 0x3b4e38a467709799, 0xa594f6da61a408ff, 0x588f6642df8ced59},
      {{6, 3, 3}, 51058, 0x3a9afe8b956fac40, 0x898c1344008e8bcc, 0x1579d5e2142058eb},
      {{7, 1, 3}, 57452, 0x4c2603cacac15ebc, 0x8881ea4ceb713fb0, 0x54753c80e50e92b8},
      {{8, 2, 3}, 62405, 0x27a767f20d6acef3, 0x873fbc8223ce12b3, 0x625765c07aadc8e0},
      {{6, 2, 4}, 49918, 0xe6e06b7eebb4f75d, 0x9802dc25e26f0919, 0x235a6a62cb2e199a},
      {{7, 2, 4}, 61159, 0xc342a52e34059dab, 0xe5dd76e6201d238f, 0x74be736e795211df},
      {{8, 1, 4}, 63006, 0xe7bf41eb767d5903, 0x26c537cae2999ba6, 0x5307a75ce160f557},
  };
  REQUIRE(std::size(all) == std::size(kCases));
  for (const Expected& expected : all) {
    INFO(name(expected.of));
    Random random(8);
    const Layout layout = layout_of(expected.of);
    const LazBytes chunk = encode_chunk(layout, plausible_records(layout, 5000, random));
    CHECK(chunk.size() == expected.bytes);
    CHECK(digest(chunk) == expected.plausible);
    CHECK(digest(encode_chunk(layout, leaping_records(layout, 5000, random))) == expected.leaping);
    CHECK(digest(encode_chunk(layout, random_records(layout, 500, random))) == expected.random);
  }
}

TEST_CASE("files that LASzip wrote have the records of their twins, and the encoder writes their bytes",
          "[laz]") {
  const fs::path folder = "/work/shared/data/las";
  for (const std::string file : {"simple", "autzen_trim"}) {
    if (!fs::exists(folder / (file + ".laz"))) return skip((folder / file).string() + " is absent");
    const LazBytes twin = bytes_of(read_file(folder / (file + ".las"))),
                   laz = bytes_of(read_file(folder / (file + ".laz"))), records = records_of_file(laz);
    INFO(file);
    REQUIRE(records.size() ==
            number<std::uint32_t>(twin, 107) * std::size_t{number<std::uint16_t>(twin, 105)});
    CHECK(std::equal(records.begin(), records.end(), twin.begin() + number<std::uint32_t>(twin, 96)));
    const std::uint32_t data = number<std::uint32_t>(laz, 96);
    const Layout layout = laz_layout(3, 0, 50000, 2);
    std::vector<std::uint64_t> chunks;
    for (std::uint64_t left = records.size() / layout.record_bytes(); left > 0; left -= chunks.back())
      chunks.push_back(std::min<std::uint64_t>(left, layout.chunk_points));
    CHECK((laz_point_data(layout, records, chunks, data) == LazBytes(laz.begin() + data, laz.end())));
  }
}

TEST_CASE("records are the same after compression and decompression", "[laz]") {
  Random random(1);
  for (const Case& c : all_cases()) {
    INFO(name(c));
    const Layout layout = layout_of(c);
    const auto check = [&](const LazBytes& records) {
      const std::size_t points = records.size() / layout.record_bytes();
      CHECK((decoded(layout, encode_chunk(layout, records), points) == records));
    };
    for (const std::size_t points : {1, 2, 3, 50, 5000}) {
      check(plausible_records(layout, points, random));
      check(random_records(layout, std::min<std::size_t>(points, 1000), random));
    }
    // All the same, and the largest steps.
    const LazBytes one = random_records(layout, 1, random);
    LazBytes records;
    for (int i = 0; i < 300; ++i) records.insert(records.end(), one.begin(), one.end());
    check(records);
    for (std::size_t i = 0; i < 300; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        using Limits = std::numeric_limits<std::int32_t>;
        const std::int32_t values[] = {0, Limits::min(), Limits::max()};
        store(&records[i * one.size() + axis * 4], values[below(random, 3)]);
      }
    }
    check(records);
  }
}

TEST_CASE("wave packets that follow each other, stay, step and leap are the same after compression",
          "[laz]") {
  Random random(5);
  for (const Case& c : kPacketCases) {
    INFO(name(c));
    const Layout layout = layout_of(c);
    constexpr std::size_t kPoints = 2000;
    LazBytes records = plausible_records(layout, kPoints, random);
    const std::size_t size = layout.record_bytes(), packet = size - c.extra_bytes - 29;
    std::uint64_t offset = 1000;
    for (std::size_t i = 0; i < kPoints; ++i) {
      const std::uint32_t bytes = 64 * (1 + below(random, 3));
      std::byte* const at = &records[i * size + packet];
      store(at + 1, offset);
      store(at + 9, bytes);
      const unsigned kind = below(random, 8);
      if (kind < 4) offset += bytes;
      if (kind == 5) offset -= below(random, 100'000);
      if (kind == 6) offset += std::uint64_t{1} << 40;
    }
    CHECK((decoded(layout, encode_chunk(layout, records), kPoints) == records));
  }
}

TEST_CASE("a chunk has the same points, however few of its bytes and points are decoded at a time", "[laz]") {
  Random random(7);
  constexpr std::size_t kPoints = 300;
  for (const Case& c : kCases) {
    const Layout layout = layout_of(c);
    const LazBytes whole = plausible_records(layout, kPoints, random);
    const LazBytes chunk = encode_chunk(layout, whole);
    for (const std::size_t piece : {1u, 7u, 512u}) {
      for (const std::size_t block : {1u, 2u, 77u, 1000u}) {
        const ChunkInPieces bytes(chunk, piece);
        laz::ChunkDecoder decoder(layout, bytes);
        LazBytes records(whole.size());
        std::span<std::byte> left = records;
        while (!left.empty()) {
          const std::size_t count = std::min(left.size(), block * layout.record_bytes());
          decoder.decode(left.first(count));
          left = left.subspan(count);
        }
        INFO(name(c) << ", pieces of " << piece << " bytes, blocks of " << block << " points");
        CHECK((records == whole));
      }
    }
  }
}

TEST_CASE("a chunk with changed sizes of layers gives records or an error", "[laz]") {
  Random random(6);
  for (const Case& c : kCases) {
    if (c.version < 3) continue;
    const Layout layout = layout_of(c);
    const LazBytes chunk = encode_chunk(layout, plausible_records(layout, 40, random));
    for (std::size_t layer = 0; layer < 9; ++layer) {
      for (const std::uint32_t size : {0u, 1u, 3u, 4u, 100000u, 0xffffffffu}) {
        LazBytes changed = chunk;
        store(&changed[layout.record_bytes() + 4 + layer * 4], size);
        const std::string error = message([&] { decoded(layout, changed, 40); });
        INFO(name(c) << ", layer " << layer << " of " << size << " bytes: " << error);
        if (size >= 100000 || (layer == 0 && size == 0)) CHECK(error != "");
      }
    }
  }
}

TEST_CASE("the layout of compressed points is read from its record", "[laz]") {
  for (const Case& c : kCases) {
    const Layout layout = layout_of(c, 50000);
    const LazBytes record = laz::layout_record(layout);
    const Layout read = laz::parse_layout(record);
    CHECK(read.compressor == layout.compressor);
    CHECK(read.chunk_points == 50000);
    CHECK(read.record_bytes() == layout.record_bytes());
    CHECK(read.items.size() == layout.items.size());
    for (std::size_t length = 0; length < record.size(); ++length)
      CHECK_THROWS_AS(laz::parse_layout(std::span(record).first(length)), Corrupt);
  }
}

TEST_CASE("layouts that are not supported are errors that name the reason", "[laz]") {
  using namespace laz::item_type;
  const auto error_of = [](const Layout& layout) {
    return message([&] { laz::parse_layout(laz::layout_record(layout)); });
  };
  const laz::Item point{kPoint10, 20, 2}, point14{kPoint14, 30, 3};
  CHECK(error_of({2, 50000, {point}}) == "");
  CHECK(error_of({2, 50000, {point, {kGpsTime11, 8, 2}, {kWavepacket13, 29, 1}}}) == "");
  struct Refused {
    std::uint16_t compressor;
    std::vector<laz::Item> items;
    const char* part;
  };
  for (const auto& [compressor, items, part] :
       {Refused{
            2, {point, {kWavepacket13, 28, 1}}, "WAVEPACKET13 of version 1 and 28 bytes has a wrong size"},
        {3, {{kPoint14, 30, 5}}, "POINT14 of version 5 and 30 bytes is not supported (version 3 and 4 are)"},
        {2, {point14}, "POINT14 of version 3 and 30 bytes does not belong to the compressor"},
        {2, {{kPoint10, 21, 2}}, "POINT10 of version 2 and 21 bytes has a wrong size"},
        {2, {point, {kByte, 0, 2}}, "BYTE of version 2 and 0 bytes has a wrong size"},
        {2, {{kPoint10, 20, 1}}, "`laszip` decompresses files from before 2011"},
        {1, {point}, "compressor 1 is not supported (2 and 3 are); `laszip` decompresses files from before"},
        {3, {point14, {kRgb14, 6, 4}}, "RGB14 of version 4 and 6 bytes has not the version of the items"},
        {2, {{kGpsTime11, 8, 2}, point}, "is in a wrong place"},
        {2, {point, point}, "is in a wrong place"},
        {2, {point, {kRgb12, 6, 2}, {kGpsTime11, 8, 2}}, "is in a wrong place"},
        {3, {point14, {kRgb14, 6, 3}, {kRgbNir14, 8, 3}}, "RGBNIR14 of version 3 and 8 bytes is in a wrong"},
        {2, {{99, 20, 2}}, "item type 99 of the compressed points is not known"},
        {0, {point}, "compressor 0 is not supported (2 and 3 are)"},
        {4, {point}, "compressor 4 is not supported (2 and 3 are)"},
        {2, {}, "does not hold its 0 items"}})
    CHECK_THAT(error_of({compressor, 50000, items}), Contains(part));
  // As LASzip takes it.
  CHECK(laz::parse_layout(laz::layout_record({3, 0, {point14}})).chunk_points == laz::kVariableChunks);
}

TEST_CASE("chunk tables that do not fit the file are errors", "[laz]") {
  const Layout layout = laz_layout(0, 0, laz::kVariableChunks, 2);
  const auto table_of = [&](const std::vector<Chunk>& chunks) {
    return laz::encode_chunk_table(layout, chunks);
  };
  const LazBytes table = table_of({{0, 500, 20}, {0, 400, 30}, {0, 20, 1}});
  const auto read = [&](const LazBytes& bytes, std::uint64_t first, std::uint64_t offset,
                        std::uint64_t points) {
    return message([&] { laz::read_chunk_table(layout, bytes, first, offset, points); });
  };
  CHECK(read(table, 100, 1020, 51) == "");
  CHECK(read(table_of({}), 100, 100, 0) == "");
  CHECK(read(table, 100, 1019, 51) == "chunk 3 of 3 reaches beyond the chunk table");
  CHECK(read(table, 100, 99, 51) == "the chunk table lies before the first chunk");
  CHECK(read(table, 100, 159, 51) == "the chunk table has 3 chunks, more than the 2 that the file can hold");
  CHECK(read(table, 100, 1020, 52) == "the chunks have 51 points, the file 52");
  CHECK(read(table, 100, 1020, 50) == "chunk 3 of 3 does not fit the number of points of the file");
  CHECK(read(table_of({{0, 19, 1}}), 100, 1020, 1) == "chunk 1 of 1 has 1 points in only 19 bytes");
  CHECK(read(table_of({{0, 20, 4000000}}), 100, 1020, 4000000) ==
        "chunk 1 of 1 has 4000000 points in only 20 bytes");
  CHECK(read(table_of({}), 100, 100, 1) == "the chunks have 0 points, the file 1");
  for (std::size_t length = 0; length < table.size(); ++length) {
    INFO("cut to " << length << " bytes");
    const auto end = table.begin() + static_cast<std::ptrdiff_t>(length);
    CHECK(read(LazBytes(table.begin(), end), 100, 1020, 51) != "");
  }
  LazBytes many = table;
  store(&many[4], 0xffffffffu);
  CHECK(read(many, 100, std::uint64_t{1} << 60, std::uint64_t{1} << 60) ==
        "the compressed points end too early");
  for (std::uint32_t i = 0; i < 2000; ++i) read(bytes_of(mutated(text_of(table), 7, i)), 100, 1020, 51);
}

}  // namespace lacuna::test
