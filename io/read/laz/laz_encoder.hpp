// SPDX-License-Identifier: Apache-2.0
// Compresses points as LAZ files have them: the counterpart of io/read/laz/laz.hpp, which cites the format. No
// file access.
#pragma once

#include "io/read/laz/laz.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lacuna::io::laz {

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
