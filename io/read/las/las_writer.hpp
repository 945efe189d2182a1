// SPDX-License-Identifier: Apache-2.0
// A LAS 1.4 file, compressed or not, that has the points of another one with more extra bytes (ASPRS LAS
// specification 1.4 R15).
#pragma once

#include "io/read/files/output_file.hpp"
#include "io/read/las/las_header.hpp"
#include "io/read/las/las_points.hpp"
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
  std::uint64_t points_ = 0, extended_at_ = 0, waveforms_at_ = 0;
  std::array<std::uint64_t, 16> of_return_{};  // points of each return number
};

}  // namespace lacuna::io
