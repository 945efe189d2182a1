// SPDX-License-Identifier: Apache-2.0
// The header of a PCD file: its fields and how they are stored.
// https://pointclouds.org/documentation/tutorials/pcd_file_format.html
#pragma once

#include "io/read/files/input_file.hpp"
#include "io/read/rows/pose.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

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
  Pose viewpoint = Pose::Identity();  // of the scanner; turns by nothing if its quaternion is 0 0 0 0

  std::size_t row_bytes() const;
  // Returns where the scanner is; nothing at 0 0 0, which is the default.
  std::optional<Eigen::Vector3d> scanner() const;
  std::size_t padding_bytes() const;  // of them, in fields named "_"
};

// Reads the header with its line DATA. Versions are .5 to .7; without SIZE, TYPE or COUNT, values are single
// floats; WIDTH x HEIGHT must equal POINTS if both are given. Throws `Error` with the line.
PcdHeader read_pcd_header(InputFile& in);

}  // namespace lacuna::io
