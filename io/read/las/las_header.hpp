// SPDX-License-Identifier: Apache-2.0
// The public header block of a LAS file, versions 1.0 to 1.5, and what its variable length records say of the
// points. Source: ASPRS LAS specification 1.4 R15, sections 2.4 to 2.7.
#pragma once

#include "io/read/files/input_file.hpp"
#include "io/read/las/las_crs.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lacuna::io {

// A descriptor of the record "Extra Bytes": what a few more bytes of each point are.
struct LasExtraBytes {
  std::string name;
  std::uint8_t type;     // 1 to 10: one value; 11 to 30: two or three values; 0: bytes without a type
  std::uint8_t options;  // of type 0 the number of bytes, else which of the following count
  double scale, offset;  // value = stored * scale + offset
  std::array<std::byte, 192> descriptor{};  // as it is in the record
};

// The place of a variable length record in its file, of either kind.
struct LasRecordExtent {
  std::string user;
  std::uint16_t number;
  std::uint64_t at;     // of its own header
  std::uint64_t bytes;  // with that header
};

struct LasHeader {
  int minor = 0;         // of version 1.x
  int point_format = 0;  // 0 to 10
  bool is_compressed = false;
  std::uint32_t points_at = 0;     // byte of the first point
  std::uint16_t record_bytes = 0;  // of a point
  std::uint64_t points = 0;
  std::array<double, 3> scale{}, offset{};
  std::vector<LasExtraBytes> extra_bytes;  // of all records of them; of the last where they do not fit
  std::uint64_t extra_records = 0;         // that do not fit a point together; else 0
  std::vector<std::byte> laszip;           // data of the record "laszip encoded"; empty without it
  LasCrs crs;
  std::vector<std::byte> bytes;  // the whole header block, as it is in the file
  std::vector<LasRecordExtent> records, extended;
  std::optional<std::uint64_t> waveforms_at;  // of the extended record with waveforms, where they are inside
};

// Returns the bytes of a point in this format, without extra bytes.
std::size_t las_point_bytes(int point_format);

// Reads up to `points_at`; `in` is at the file's beginning. Extended records behind the points are read for
// the coordinate reference system and for extra bytes alone. Throws `Error` where the header contradicts
// itself or the file.
LasHeader read_las_header(InputFile& in);

}  // namespace lacuna::io
