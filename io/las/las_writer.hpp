// SPDX-License-Identifier: Apache-2.0
// A LAS 1.4 file, compressed or not, as a stream of point records (ASPRS LAS specification 1.4 R15).
#pragma once

#include "io/las/las_join.hpp"
#include "io/las/las_points_writer.hpp"
#include "io/results/output_file.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

// The field "generating software" of each file of a LasWriter begins so, at this byte.
inline constexpr std::string_view kLasSoftware = "Lacuna ";
inline constexpr std::uint64_t kLasSoftwareAt = 58;

// The LAS file whose header fields and variable length records go over. The fields are file source id, global
// encoding, GUID, system identifier, creation date, and bytes behind the header's last field. All records go
// over byte for byte, except those of LASzip and COPC and the descriptors of extra bytes.
struct LasOrigin {
  std::filesystem::path file;
  LasHeader header;
  bool has_crs = true;      // else its records "LASF_Projection" are left out: its system is not the scan's
  bool has_counts = false;  // bounds and numbers of returns go over, since the points are the same
};

class LasWriter {
 public:
  // Writes the header and the records before the points. `results`: extra bytes behind those of the form.
  // Without an origin, the file has neither identity nor date. Unless the origin has_crs, `crs` is written:
  // well-known text, or the code of a projected or geographic (4000 to 4999) system as keys of GeoTIFF. With
  // a compression, which is one for the points of the form with the results, the file is LAZ.
  LasWriter(OutputFile& out, LasForm form, std::span<const LasExtraBytes> results,
            std::optional<LasOrigin> origin, std::string_view crs,
            std::optional<LasCompression> compression = {});

  std::size_t record_bytes() const { return record_bytes_; }
  void put(std::span<const std::byte> records);
  // Writes the extended records, and the header once more.
  void finish();

 private:
  void write_records(const std::vector<LasExtraBytes>& extra, std::string_view crs,
                     const std::optional<LasCompression>& compression);
  void write_extended();
  void complete_header();

  OutputFile& out_;
  LasForm form_;
  std::optional<LasOrigin> origin_;
  std::size_t record_bytes_;
  std::string header_;
  std::uint64_t written_ = 0;  // bytes, but for the points
  std::unique_ptr<LasPointsWriter> points_out_;
  std::string long_text_;  // a well-known text that needs an extended record
  std::uint32_t records_ = 0, extended_ = 0;
  std::uint64_t points_ = 0, extended_at_ = 0, waveforms_at_ = 0;
  std::array<std::uint64_t, 15> returns_{};  // points of each number of return
  std::array<std::int32_t, 3> min_, max_;    // of stored coordinates
};

}  // namespace lacuna::io
