#include "io/laz/laz.hpp"

#include "io/laz/layered.hpp"
#include "io/laz/pointwise.hpp"

#include <cassert>

namespace lacuna::laz {

void decode_chunk(const Layout& layout, std::span<const std::byte> chunk, std::uint64_t points,
                  std::span<std::byte> records) {
  assert(records.size() == points * layout.record_bytes());
  if (points == 0) return;
  if (layout.compressor == compressor::kLayeredChunked) {
    decode_layered(layout, chunk, points, records);
  } else {
    decode_pointwise(layout, chunk, points, records);
  }
}

}  // namespace lacuna::laz
