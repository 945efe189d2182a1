// SPDX-License-Identifier: Apache-2.0
// Chunks of point formats 0 to 3: all items of a point in one stream, point by point (LAZ, compressors 1 and
// 2).
#pragma once

#include "io/read/laz/laz.hpp"
#include "io/read/laz/record_decoder.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace lacuna::io::laz {

// The records of a chunk after the first, which is not compressed.
std::unique_ptr<RecordDecoder> pointwise_decoder(const Layout& layout, const ChunkBytes& bytes,
                                                 std::span<const std::byte> first);

// Encodes a chunk of the given records, at least one, with items of version 2.
std::vector<std::byte> pointwise_chunk(const Layout& layout, std::span<const std::byte> records);

}  // namespace lacuna::io::laz
