// SPDX-License-Identifier: Apache-2.0
// The raw point records of a LAS file, compressed or not: read and written front to back. LasWriter writes a
// file of LAS 1.4 with the points of another one and more extra bytes (ASPRS LAS specification 1.4 R15).
#pragma once

#include "io/read/files/input_file.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/las/las_header.hpp"
#include "io/read/laz/laz.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

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

// The header of the other file goes over, as LAS 1.4 has it. It has the point format, scale, offset, bounds,
// numbers of returns, identity and date, and maybe bytes behind its last field. If it counts other points
// than are put, all are counted anew. All records go over byte for
// byte, except the records of LASzip and COPC and the descriptors of extra bytes.
class LasWriter final : public RowsWriter {
 public:
  // Writes the header and the records before the points. `from` is the header of `file`. `extra`: all extra
  // bytes of the points to come, which have `record_bytes` each. With a compression, which is one for these
  // points, the file is LAZ.
  LasWriter(OutputFile& out, const std::filesystem::path& file, const LasHeader& from,
            std::span<const LasExtraBytes> extra, std::size_t record_bytes,
            std::optional<LasCompression> compression = {});

  void put_rows(std::span<const std::byte> records) override;
  // Writes the extended records, and the header once more.
  void finish() override;

 private:
  void write_records(std::span<const LasExtraBytes> extra, const std::optional<LasCompression>& compression);
  void write_extended();
  void complete_header();
  void count_anew();

  OutputFile& out_;
  std::filesystem::path file_;
  LasHeader from_;
  std::size_t record_bytes_;
  std::string header_;
  std::uint64_t written_ = 0;  // bytes, but for the points
  std::unique_ptr<LasPointsWriter> points_out_;
  std::uint32_t records_ = 0, extended_ = 0;
  std::uint64_t points_ = 0, extended_at_ = 0;
  std::array<std::uint64_t, 16> of_return_{};  // points of each return number
};

}  // namespace lacuna::io
