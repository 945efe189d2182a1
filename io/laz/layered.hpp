// Chunks of point formats 6 to 8: each attribute in a stream of its own (LAZ, compressor 3).
#pragma once

#include "io/laz/laz.hpp"

namespace lacuna::laz {

// As decode_chunk(), for at least one point.
void decode_layered(const Layout& layout, std::span<const std::byte> chunk, std::uint64_t points,
                    std::span<std::byte> records);

}  // namespace lacuna::laz
