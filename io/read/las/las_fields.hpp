// SPDX-License-Identifier: Apache-2.0
// Places of the fields of each point format in a record (ASPRS LAS specification 1.4 R15, section 2.6).
#pragma once

#include "io/read/rows/scan_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacuna::io {

struct LasField {
  const char* name;  // of its column
  Scalar type;       // of its column
  std::size_t offset;
  std::uint8_t shift = 0, bits = 0;  // of a byte; bits 0: the whole value
  std::uint8_t stored = 0;           // type of extra bytes as which it is stored, if that is another
  double scale = 1;                  // of the stored value
};

// Returns all fields but the coordinates, which are the first twelve bytes, in the order of their columns.
// `format` is 0 to 10.
std::vector<LasField> las_fields(int format);

}  // namespace lacuna::io
