// SPDX-License-Identifier: Apache-2.0
// Decompresses and compresses the points of LAZ files, whose bytes the caller provides: no file access.
//
// Idea: a chunk of points begins with a whole one. Of each other point, every field is predicted from the
// points before it, and an adaptive arithmetic coder takes the difference. Points of formats 0 to 5 are one
// stream (pointwise.cpp). Those of formats 6 to 10 have a stream for each attribute (layered.cpp).
// Memory has the bounds decoder_bytes() and encoder_bytes().
//
// The format: M. Isenburg, "LASzip: lossless compression of LiDAR data", Photogrammetric Engineering & Remote
// Sensing 79(2), 2013, and "LAZ specification 1.4", rapidlasso, below cited as "LAZ". The arithmetic coder:
// A. Said, "Introduction to arithmetic coding", HP Labs report HPL-2004-76, below cited as "Said".
//
// The points of a LAZ file follow from the LAS header's `offset to point data`, P.
// P has the offset of the chunk table, 8 bytes, signed. The first chunk begins at P + 8, the next one
// directly behind it. An offset of -1, or another that is not behind P, comes from a writer that could not
// seek. The last 8 bytes of the file hold the offset then. Compressor 1 had no table, and is not read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

namespace lacuna::io::laz {

// An error in compressed data, one line; the caller adds file and place.
class Corrupt : public std::runtime_error {
  using runtime_error::runtime_error;
};

// Part of a point record that is compressed on its own (LAZ, "LASzip VLR").
struct Item {
  std::uint16_t type;
  std::uint16_t size;  // bytes
  std::uint16_t version;
};

namespace item_type {
inline constexpr std::uint16_t kByte = 0;
inline constexpr std::uint16_t kPoint10 = 6;
inline constexpr std::uint16_t kGpsTime11 = 7;
inline constexpr std::uint16_t kRgb12 = 8;
inline constexpr std::uint16_t kWavepacket13 = 9;
inline constexpr std::uint16_t kPoint14 = 10;
inline constexpr std::uint16_t kRgb14 = 11;
inline constexpr std::uint16_t kRgbNir14 = 12;
inline constexpr std::uint16_t kWavepacket14 = 13;
inline constexpr std::uint16_t kByte14 = 14;
}  // namespace item_type

namespace compressor {
inline constexpr std::uint16_t kPointwiseChunked = 2;
inline constexpr std::uint16_t kLayeredChunked = 3;
}  // namespace compressor

inline constexpr std::uint32_t kVariableChunks = 0xffffffff;

// The compression of the records of a file.
struct Layout {
  std::uint16_t compressor;
  std::uint32_t chunk_points;  // kVariableChunks: the chunk table has each chunk's number of points
  std::vector<Item> items;     // in the order of their bytes in a record

  std::size_t record_bytes() const;
};

// Reads the data of the variable length record with user id "laszip encoded" and record id 22204. Supports
// POINT10, GPSTIME11, RGB12 and BYTE of version 2, and WAVEPACKET13 of version 1 (point formats 0 to 5). Of
// version 3 and 4, it supports POINT14, RGB14, RGBNIR14, WAVEPACKET14 and BYTE14 (point formats 6 to 10).
// Throws `Corrupt` for other items, with the item's name.
Layout parse_layout(std::span<const std::byte> record);

// No encoder gets more points into a byte. Each point takes at least the symbol that says what changed. It is
// one of 64 symbols or more, with at least one count each of at most 2^15, which is 0.0027 bits.
inline constexpr std::uint64_t kMostPointsInAByte = 4096;

struct Chunk {
  std::uint64_t offset;  // in the file, bytes
  std::uint64_t bytes;
  std::uint64_t points;
};

// Returns the chunks in the order of the file; their points add up to `points`, the number of points of the
// file. `table` has the file's bytes from `table_offset` on, up to the end of the table or any later byte, at
// most chunk_table_bytes(). `first_chunk` is the offset of the first chunk. Memory is at most one Chunk for
// each record_bytes() between the two offsets. Throws `Corrupt` if the table is cut or does not fit the file.
std::vector<Chunk> read_chunk_table(const Layout& layout, std::span<const std::byte> table,
                                    std::uint64_t first_chunk, std::uint64_t table_offset,
                                    std::uint64_t points);

// Returns a bound on the bytes of a table, from its first 8 bytes. The caller gives read_chunk_table() as
// many bytes of the file, or all that follow.
std::uint64_t chunk_table_bytes(std::span<const std::byte> first_8_bytes);

// The compressed bytes of a chunk: in memory, or read piece by piece.
class ChunkBytes {
 public:
  virtual ~ChunkBytes() = default;
  virtual std::uint64_t size() const = 0;
  // Bytes from `begin` on: at least one, at most up to `end`, which is behind `begin` and within the size.
  // They may lie in `buffer`, which the caller leaves unchanged as long as it uses them.
  virtual std::span<const std::byte> read(std::uint64_t begin, std::uint64_t end,
                                          std::vector<std::byte>& buffer) const = 0;
};

class ChunkInMemory final : public ChunkBytes {
 public:
  explicit ChunkInMemory(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::uint64_t size() const override { return bytes_.size(); }
  std::span<const std::byte> read(std::uint64_t begin, std::uint64_t end,
                                  std::vector<std::byte>&) const override {
    return bytes_.subspan(begin, end - begin);
  }

 private:
  std::span<const std::byte> bytes_;
};

class RecordDecoder;

// Decompresses the records of a chunk, record_bytes() each, as they are in an uncompressed LAS file. It goes
// from front to back, as many records at a time as the caller wants. Several threads may decode chunks at the
// same time. Throws `Corrupt` if the chunk is cut or cannot be right. Changed bytes inside a chunk are not
// always noticed, since the format has no checksum. Memory, whatever the size of the chunk: decoder_bytes(),
// and a buffer for each stream that is read piece by piece.
class ChunkDecoder {
 public:
  // Layout and bytes outlive the decoder.
  ChunkDecoder(const Layout& layout, const ChunkBytes& bytes);
  ~ChunkDecoder();

  // The next records, never more than the chunk has.
  void decode(std::span<std::byte> records);
  // Whether the chunk holds other records than those `points` that are decoded. Chunks of layers say how many
  // they hold. Others end in the state that an encoder leaves. Records that equal the one before may take no
  // bits that show in it.
  bool has_other_than(std::uint64_t points);

 private:
  void begin_rest();
  const Layout& layout_;
  const ChunkBytes& bytes_;
  std::vector<std::byte> first_;         // the first record; empty before it was read
  std::unique_ptr<RecordDecoder> rest_;  // null before the second record
};

// A bound on the memory of a decoder.
std::uint64_t decoder_bytes(const Layout& layout);

// The number of streams that a chunk consists of: 1, or one for each layer.
std::size_t stream_count(const Layout& layout);

// Returns how points of this format, from 0 to 10, are compressed, with `extra_bytes` behind the format's
// fields. Formats 0 to 5 use compressor 2 with items of version 2, and 1 for waveforms. The others use
// compressor 3 with items of version 3. A chunk has 50,000 points, as LASzip's; fewer if these take more than
// kMostChunkBytes.
Layout layout_of(int point_format, std::uint16_t extra_bytes);
inline constexpr std::size_t kMostChunkBytes = std::size_t{4} << 20;

// Returns the data of the variable length record "laszip encoded" (user id) 22204, which parse_layout()
// reads.
std::vector<std::byte> layout_record(const Layout& layout);

// Encodes a chunk of the given records, at least one, record_bytes() each. Several threads may encode chunks
// at the same time. Memory: encoder_bytes(), and up to twice the bytes of the chunk. The layout is one of
// layout_of(), or has other numbers of points or items of version 4.
std::vector<std::byte> encode_chunk(const Layout& layout, std::span<const std::byte> records);

// Returns a bound on the memory of the models that encode a chunk.
std::uint64_t encoder_bytes(const Layout& layout);

// Encodes the table of the given chunks, in the order of the file; the table does not hold their offsets.
std::vector<std::byte> encode_chunk_table(const Layout& layout, std::span<const Chunk> chunks);

}  // namespace lacuna::io::laz
