// Chunks of point formats 6 to 8: each attribute in a stream of its own (LAZ, compressor 3).
#pragma once

#include "io/laz/laz.hpp"

namespace lacuna::io::laz {

// The records of a chunk behind the first, which is in `records` already. `compressed`: what follows it in
// the chunk.
void decode_layered(const Layout& layout, std::span<const std::byte> compressed,
                    std::span<std::byte> records);

}  // namespace lacuna::io::laz
