// SPDX-License-Identifier: Apache-2.0
// The two kinds of chunks: point by point (pointwise.cpp), and a layer for each attribute (layered.cpp).
#pragma once

#include "io/read/laz/laz.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lacuna::io::laz {

// Decodes the records of a chunk after the first, from front to back.
class RecordDecoder {
 public:
  virtual ~RecordDecoder() = default;
  virtual void decode(std::span<std::byte> records) = 0;
  // As `ChunkDecoder::has_other_than`.
  virtual bool has_other_than(std::uint64_t points) const = 0;
};

// Chunks of point formats 0 to 3: all items of a point in one stream, point by point (LAZ, compressors 1 and
// 2).

// The records of a chunk after the first, which is not compressed.
std::unique_ptr<RecordDecoder> pointwise_decoder(const Layout& layout, const ChunkBytes& bytes,
                                                 std::span<const std::byte> first);

// Encodes a chunk of the given records, at least one, with items of version 2.
std::vector<std::byte> pointwise_chunk(const Layout& layout, std::span<const std::byte> records);

// Chunks of point formats 6 to 8: each attribute in a stream of its own (LAZ, compressor 3).

// The records of a chunk after the first, which is not compressed.
std::unique_ptr<RecordDecoder> layered_decoder(const Layout& layout, const ChunkBytes& bytes,
                                               std::span<const std::byte> first);

// Encodes a chunk of the given records, at least one.
std::vector<std::byte> layered_chunk(const Layout& layout, std::span<const std::byte> records);

std::size_t layer_count(const Layout& layout);

}  // namespace lacuna::io::laz
