// SPDX-License-Identifier: Apache-2.0
// The raw point records of a LAS file, compressed or not, front to back.
#pragma once

#include "io/read/files/input_file.hpp"
#include "io/read/las/las_header.hpp"
#include "io/read/options/trust.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace lacuna::io {

class LasPoints {
 public:
  virtual ~LasPoints() = default;
  // The next records, as many as fit: never more than are left. Throws `Error`.
  virtual void read(std::span<std::byte> records) = 0;
};

// `in`: the file, just before its points. It must outlive the result. Throws `Error` where the file is too
// short for the points of its header. LAZ: `memory` bytes bound what is held. Chunks that fit are
// decompressed by several threads: one for each, or up to four while these are small. A larger chunk is
// decompressed in the blocks that are read, by one thread. Where even its models do not fit, that is an
// `Error`.
// `trust`: kHeader: more compressed points than the header counts are no error, and are left.
std::unique_ptr<LasPoints> las_points(InputFile& in, const LasHeader& header, Trust trust,
                                      std::uint64_t memory);

}  // namespace lacuna::io
