// Chunks of point formats 0 to 3: all items of a point in one stream, point by point (LAZ, compressors 1 and
// 2).
#pragma once

#include "io/laz/laz.hpp"

namespace lacuna::io::laz {

// The records of a chunk behind the first, which is in `records` already. `compressed`: what follows it in
// the chunk.
void decode_pointwise(const Layout& layout, std::span<const std::byte> compressed,
                      std::span<std::byte> records);

}  // namespace lacuna::io::laz
