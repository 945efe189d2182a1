// SPDX-License-Identifier: Apache-2.0
// Chunks of point formats 6 to 8: each attribute in a stream of its own (LAZ, compressor 3).
#pragma once

#include "io/read/laz/laz.hpp"
#include "io/read/laz/record_decoder.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace lacuna::io::laz {

// The records of a chunk after the first, which is not compressed.
std::unique_ptr<RecordDecoder> layered_decoder(const Layout& layout, const ChunkBytes& bytes,
                                               std::span<const std::byte> first);

// Encodes a chunk of the given records, at least one.
std::vector<std::byte> layered_chunk(const Layout& layout, std::span<const std::byte> records);

std::size_t layer_count(const Layout& layout);

}  // namespace lacuna::io::laz
