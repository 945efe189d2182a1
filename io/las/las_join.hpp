// SPDX-License-Identifier: Apache-2.0
// One form of LAS points for the points of all files of a scan.
//
// Coordinates. Where all files are LAS with one scale and offset, these stay, and so does every stored
// integer. Else each axis gets the smallest of the scales, divided by a power of ten up to 10^6 where that is
// needed. Every file's coordinates are then whole multiples of it, the same decimal numbers. Offsets count as
// equal within a thousandth of such a step, since doubles round decimal numbers. The offset is the first
// file's, moved by a multiple of the scale where 32 bits need it. Points from other formats, or with a pose,
// are rounded to the nearest multiple of the finest such scale for which 32 bits suffice. Without any LAS
// file, it is the finest power of ten. That gives about 4e8 steps or more across the scan, finer than 32-bit
// floats at its farthest point. The offset is then the middle of the scan, round to a power of ten.
//
// Fields. The point format has the fields of all: formats 0 to 5 become 6 to 10 next to one of these. Steps
// of 0.006 degrees then stand for the whole degrees of a scan angle, and class 12 becomes class 1 with the
// flag of overlap. Columns of other formats become the fields of their names (Intensity or scalar_intensity
// is intensity) if all their values fit exactly. They must be whole and in the range of the field; colours of
// 0 to 255 are multiplied by 257. All other columns become extra bytes.
//
// Extra bytes. Those of one name are one. Where types, scales or "no data" values differ, they are in double,
// with NaN for no data. A file that has none of a name gets what las_extra_missing says.
#pragma once

#include "io/las/las_extra.hpp"
#include "io/las/las_fields.hpp"
#include "io/las/las_header.hpp"
#include "io/scan_reader.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna::io {

// A LAS file of the scan.
struct LasPart {
  std::string name;  // for errors
  LasHeader header;
  bool has_pose = false;
};

// A column of the files of other formats, joined, with what its values are.
struct ImportedColumn {
  Property property;
  bool is_whole = true;  // every value is a whole number
  double min = std::numeric_limits<double>::infinity(), max = -std::numeric_limits<double>::infinity();
};

struct LasExtraField {
  LasExtraBytes what;
  std::size_t offset, bytes;  // in a record
};

// Where a column of other formats goes.
struct ImportedField {
  Property from;
  std::optional<LasField> field;  // none: extra bytes
  std::size_t extra = 0;          // index of these
  double factor = 1;
};

struct LasForm {
  int point_format = 6;
  bool has_standard_time = false;  // GPS times count from 1980, not from a week's beginning
  std::array<double, 3> scale{}, offset{};
  std::vector<LasExtraField> extra;
  std::size_t record_bytes = 0;
  std::vector<ImportedField> imported;  // of the columns, without x y z
  bool is_as_it_was = false;            // one LAS file without a pose, whose points stay byte for byte
  bool keeps_results = false;           // of earlier runs, as LasParts has it
  std::string name;                     // likewise
};

// What is to be joined.
struct LasParts {
  std::vector<LasPart> las;
  std::vector<ImportedColumn> imported;  // x y z too, if there are files of other formats
  Eigen::AlignedBox3d bounds;            // of all points where coordinates change, once known
  std::string crs;                       // of files of other formats
  bool keeps_results = false;            // extra bytes that an earlier run has written stay
  std::string name;                      // of the file that is written, for errors
};

// Throws `Error` where it is not possible. Coordinates may not fit one scale, and times may be of different
// kinds. Waveforms may come from several files. Arrays of extra bytes may differ, or records exceed 65535
// bytes. The error names the file and the way out.
LasForm join_las(const LasParts& parts);

}  // namespace lacuna::io
