// Chunks of point formats 0 to 3: all items of a point in one stream, point by point (LAZ, compressors 1 and
// 2).
#pragma once

#include "io/laz/laz.hpp"

namespace lacuna::laz {

// As decode_chunk(), for at least one point.
void decode_pointwise(const Layout& layout, std::span<const std::byte> chunk, std::uint64_t points,
                      std::span<std::byte> records);

}  // namespace lacuna::laz
