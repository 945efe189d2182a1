// SPDX-License-Identifier: Apache-2.0
// The header of a PCD file: its fields and how they are stored.
// https://pointclouds.org/documentation/tutorials/pcd_file_format.html
#pragma once

#include "io/input_file.hpp"
#include "io/local_offset.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

enum class PcdEncoding : std::uint8_t { kAscii, kBinary, kCompressed };
const char* pcd_name(PcdEncoding encoding);  // "ascii", "binary", "binary_compressed"

struct PcdField {
  std::string name;
  char type = 'F';       // 'I', 'U' or 'F'
  std::size_t size = 4;  // bytes of a value
  std::size_t count = 1;

  std::size_t bytes() const { return size * count; }
  bool is_padding() const { return name == "_"; }
};

struct PcdHeader {
  std::vector<PcdField> fields;  // at least one, with at most 65,536 values together
  std::uint64_t rows = 0;        // as declared: nothing may be allocated by it
  PcdEncoding encoding = PcdEncoding::kAscii;
  std::uint64_t width = 0, height = 1;  // of the image that the rows are; their product is `rows`
  // The scanner's position, in the coordinates of the points, and the quaternion w x y z of its direction.
  std::array<double, 7> viewpoint{0, 0, 0, 1, 0, 0, 0};
  LocalOffset offset;  // of the coordinates and the viewpoint, as a comment states it

  std::size_t row_bytes() const;
  // Where the scanner is in the coordinates of the scan. None at 0 0 0 of the file, which is the default.
  std::optional<Eigen::Vector3d> scanner() const;
  std::size_t padding_bytes() const;  // of them, in fields named "_"
};

// The header as text up to and with the line DATA, version .7, with kPcdMark.
std::string print_pcd_header(const PcdHeader& header);
inline constexpr std::string_view kPcdMark = "# .PCD v0.7 - written by Lacuna\n";

// Reads up to and with the line DATA. Versions .5 to .7; without SIZE, TYPE or COUNT, values are single
// floats; WIDTH x HEIGHT must equal POINTS where both are given. Throws `Error` with the line.
PcdHeader read_pcd_header(InputFile& in);

}  // namespace lacuna::io
