// SPDX-License-Identifier: Apache-2.0
// What an E57 file declares: its header, and the XML section that describes its scans. ASTM E2807-11.
#pragma once

#include "io/read/e57/paged_file.hpp"
#include "io/read/rows/pose.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lacuna::io {

// One element of the prototype of a scan's points.
struct E57Field {
  enum class Type : std::uint8_t { kFloat32, kFloat64, kInteger, kScaledInteger };
  std::string name;  // as in the file, with the prefix of its extension
  Type type = Type::kFloat64;
  unsigned bits = 64;            // of a value; 0: each is the minimum
  std::int64_t minimum = 0;      // of integers, which are stored less this
  double scale = 1, offset = 0;  // a scaled integer i stands for i * scale + offset

  bool operator==(const E57Field&) const = default;
};

// An entry of data3D.
struct E57Scan {
  std::uint64_t points_at = 0;  // physical offset of the section of its points; 0: none
  std::uint64_t records = 0;
  std::vector<E57Field> fields;  // in the order of their bytestreams; none where there are no records
  Pose pose = Pose::Identity();
  bool has_pose = false;           // the file states it
  bool has_zero_rotation = false;  // its quaternion is 0 0 0 0, taken for no rotation
};

struct E57Header {
  std::size_t page_bytes = 0;
  std::string coordinate_metadata;  // the coordinate system as WKT; empty: not stated
  std::vector<E57Scan> scans;
};

// Throws `Error` unless the version is 1.0, the sizes hold and the scans can be read. The number of records
// of a scan is no more than the file could hold, where a record of no bits counts as one bit. All scans
// together have at most 64 values for each byte of the file.
// Memory: up to 17 times the XML section, which may have up to 16 MiB and be no larger than the file.
E57Header read_e57_header(const std::filesystem::path& file);

// Reads the scans and coordinate metadata of an XML section of `bytes` logical bytes at the position of
// `pages`.
void read_e57_xml(PagedFile& pages, std::size_t bytes, E57Header& header);

}  // namespace lacuna::io
