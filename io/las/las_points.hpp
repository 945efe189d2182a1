// The raw point records of a LAS file, compressed or not, front to back.
#pragma once

#include "io/input_file.hpp"
#include "io/las/las_header.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace lacuna::io {

class LasPoints {
 public:
  virtual ~LasPoints() = default;
  // The next records, as many as fit: never more than are left. Throws `Error`.
  virtual void read(std::span<std::byte> records) = 0;
};

// `in`: the file, just before its points. It must outlive the result. Throws `Error` where the file has no
// room for the points of its header. LAZ: the chunks are decompressed by several threads. Memory: one chunk
// for each thread, or up to four while these are small; a chunk larger than 256 MiB is an `Error`.
std::unique_ptr<LasPoints> las_points(const std::filesystem::path& file, InputFile& in,
                                      const LasHeader& header);

}  // namespace lacuna::io
