// SPDX-License-Identifier: Apache-2.0
// Compressed points of every version that the decoder reads, for its tests. The encoder of io/read/laz makes them,
// and one for version 1, which Lacuna does not write.
#pragma once

#include "io/read/laz/laz.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::test {

using LazBytes = std::vector<std::byte>;

// The items of a point format, 0 to 3 with version 1 or 2, or 6 to 8 with version 3 or 4. `extra_bytes` are
// behind them. `chunk_points`: laz::kVariableChunks writes the number of points of each chunk.
io::laz::Layout laz_layout(int point_format, std::uint16_t extra_bytes, std::uint32_t chunk_points,
                           std::uint16_t version);

// One chunk, of at least one record as in an uncompressed LAS file.
LazBytes laz_chunk(const io::laz::Layout& layout, std::span<const std::byte> records);

// All bytes of a file from its point data at `offset` on: the offset of the chunk table, the chunks, the
// table. `chunk_points` are the points of each chunk, together all of `records`.
LazBytes laz_point_data(const io::laz::Layout& layout, std::span<const std::byte> records,
                        std::span<const std::uint64_t> chunk_points, std::uint64_t offset);

std::string text_of(std::span<const std::byte> bytes);

// What is before the points of a file: its header and records, with that of the layout.
std::string laz_head(LasFile las, const io::laz::Layout& layout);

// The points of a file behind its head, one record after the other. Those of compressor 1 are one chunk
// without a table.
std::string laz_points(const io::laz::Layout& layout, const std::string& records,
                       const std::vector<std::uint64_t>& chunk_points, std::size_t offset);

std::string laz_file(const LasFile& las, const io::laz::Layout& layout,
                     const std::vector<std::uint64_t>& chunk_points);

}  // namespace lacuna::test
