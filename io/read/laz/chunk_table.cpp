// SPDX-License-Identifier: Apache-2.0
// The table of where chunks begin (LAZ, "Chunk table").
#include "io/read/files/little_endian.hpp"
#include "io/read/laz/integer_coder.hpp"
#include "io/read/laz/laz.hpp"
#include "io/read/laz/laz_encoder.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

namespace lacuna::io::laz {
namespace {

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

}  // namespace lacuna::io::laz
