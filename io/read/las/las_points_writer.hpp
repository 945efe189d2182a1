// SPDX-License-Identifier: Apache-2.0
// The point records of a LAS file on their way to the disk, compressed or not, front to back.
#pragma once

#include "io/read/files/output_file.hpp"
#include "io/read/laz/laz.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace lacuna::io {

// The compression of points to LAZ.
struct LasCompression {
  laz::Layout layout;
  // Bytes that bound what is held, but for one chunk, which always is. Chunks that fit are compressed by
  // several threads, one for each.
  std::uint64_t memory = 0;
};

// The bytes that one chunk takes while it is compressed. Compressed points are taken to need no more than
// plain ones.
std::uint64_t compression_bytes(const laz::Layout& layout);

class LasPointsWriter {
 public:
  virtual ~LasPointsWriter() = default;
  // Whole records. Throws `Error`.
  virtual void put(std::span<const std::byte> records) = 0;
  // Writes what is left, once. Returns the number of all bytes. Throws `Error`.
  virtual std::uint64_t finish() = 0;
};

// `out`: the file, of which `points_at` bytes are written. It must outlive the result. With a compression the
// file's bytes depend on the layout alone, not on memory and threads.
std::unique_ptr<LasPointsWriter> las_points_writer(OutputFile& out, std::uint64_t points_at,
                                                   std::optional<LasCompression> compression);

}  // namespace lacuna::io
