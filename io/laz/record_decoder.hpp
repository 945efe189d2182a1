// SPDX-License-Identifier: Apache-2.0
// The interface that the two kinds of chunks share.
#pragma once

#include <cstddef>
#include <span>

namespace lacuna::io::laz {

// Decodes the records of a chunk after the first, from front to back.
class RecordDecoder {
 public:
  virtual ~RecordDecoder() = default;
  virtual void decode(std::span<std::byte> records) = 0;
};

}  // namespace lacuna::io::laz
