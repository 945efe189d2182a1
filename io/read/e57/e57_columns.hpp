// SPDX-License-Identifier: Apache-2.0
// The columns of rows that the fields of E57 scans become.
//
//   cartesianX Y Z, or without them sphericalRange Azimuth Elevation   x y z, doubles
//   colorRed Green Blue                                                red green blue
//   normalX Y Z, also with the prefix nor:, if all three are there     nx ny nz
//   returnIndex                                     return_number: one more, since LAS counts from 1
//   returnCount                                                        number_of_returns
//   any other                        its name in snake case: rowIndex row_index, ext:someValue ext_some_value
//
// Floats keep their precision. An integer has the smallest type for all values of its bits: a colour up to
// 255 is a byte. Integers of more than 32 bits and scaled integers are doubles. The last column is `scan`, a
// uint32: the rank of the scan in the file. Scans of one file may have different fields. The file has the
// columns of all its scans, by name, in the order in which they first appear. A column with several types
// becomes doubles.
#pragma once

#include "io/read/e57/e57_header.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace lacuna::io {

struct E57Columns {
  RowLayout layout;
  std::unordered_map<std::string, std::size_t> ranks;  // of properties, by name
};

// The mapping of one scan's fields to the columns of its file.
struct E57ScanColumns {
  struct Target {
    std::size_t property;  // its rank
    std::int64_t added;    // to an integer
  };
  std::vector<Target> fields;        // of each field
  std::vector<std::size_t> missing;  // ranks of properties that the scan does not have
  bool is_spherical = false;         // x y z are given as range, azimuth and elevation
  bool has_normals = false;
  std::optional<std::size_t> invalid_state;  // the property that says which positions are none
};

// Takes the points from scans whose points have no position. Returns the number of these scans; 0, and
// changes nothing, if no scan has a position.
std::uint64_t drop_scans_without_position(E57Header& header);

// Throws `Error` unless each scan with points has a position, and the names of its columns differ.
// Cost: linear in the fields of all scans.
E57Columns e57_columns(const PagedFile& pages, const E57Header& header);

// Cost: linear in the columns of the file.
E57ScanColumns e57_scan_columns(const E57Scan& scan, const E57Columns& columns);

}  // namespace lacuna::io
