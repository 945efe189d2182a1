// SPDX-License-Identifier: Apache-2.0
// The interface that the two kinds of chunks share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace lacuna::io::laz {

// Decodes the records of a chunk after the first, from front to back.
class RecordDecoder {
 public:
  virtual ~RecordDecoder() = default;
  virtual void decode(std::span<std::byte> records) = 0;
  // As `ChunkDecoder::has_other_than`.
  virtual bool has_other_than(std::uint64_t points) const = 0;
};

}  // namespace lacuna::io::laz
