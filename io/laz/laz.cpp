#include "io/laz/laz.hpp"

#include "io/laz/layered.hpp"
#include "io/laz/pointwise.hpp"

#include <algorithm>
#include <cassert>

namespace lacuna::io::laz {

void decode_chunk(const Layout& layout, std::span<const std::byte> chunk, std::uint64_t points,
                  std::span<std::byte> records) {
  assert(records.size() == points * layout.record_bytes());
  if (points == 0) return;
  // The first point is not compressed.
  const std::size_t record_bytes = layout.record_bytes();
  if (chunk.size() < record_bytes)
    throw Corrupt("a chunk of compressed points is shorter than its first point");
  std::copy_n(chunk.begin(), record_bytes, records.begin());
  if (points == 1) return;
  if (layout.compressor == compressor::kLayeredChunked) {
    decode_layered(layout, chunk.subspan(record_bytes), records);
  } else {
    decode_pointwise(layout, chunk.subspan(record_bytes), records);
  }
}

}  // namespace lacuna::io::laz
