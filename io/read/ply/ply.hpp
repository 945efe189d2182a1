// SPDX-License-Identifier: Apache-2.0
// The header of a PLY file: what its elements are made of. https://paulbourke.net/dataformats/ply/
#pragma once

#include "io/read/files/input_file.hpp"
#include "io/read/rows/local_offset.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

enum class PlyFormat : std::uint8_t { kAscii, kLittleEndian, kBigEndian };
const char* ply_name(PlyFormat format);  // "ascii", "binary_little_endian", "binary_big_endian"

struct PlyProperty {
  std::string name;
  Scalar type = Scalar::kFloat32;    // of the value, or of the values of a list
  std::optional<Scalar> count_type;  // of the number before the values of a list; empty for a scalar
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  bool has_lists() const;
  RowLayout layout() const;  // of its scalars
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  LocalOffset offset;      // of the coordinates, as a comment states it
  std::uint64_t byes = 0;  // lines "bye", which are no keyword
};

// Reads up to and with "end_header" and its line end. All lines of the file end with a carriage return alone
// if the first one does (Rhinoceros). Names of position and normal may be capitals: X is x. Lines "bye",
// which Stanford's archive has in some headers, are counted. "Created by ..." is a
// comment (Blender 2.4). Names are unique among the elements and within each element. The counts are as
// declared: nothing may be allocated by them. Throws `Error` with the line.
PlyHeader read_ply_header(InputFile& in);

// Returns the header as text, "
// " at line ends, with one comment, and a second one for the offset.
std::string print_ply_header(const PlyHeader& header, std::string_view comment);

}  // namespace lacuna::io
