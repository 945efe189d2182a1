// SPDX-License-Identifier: Apache-2.0
// Where the fields of each point format are in a record (ASPRS LAS specification 1.4 R15, section 2.6).
#pragma once

#include "io/scan_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace lacuna::io {

struct LasField {
  const char* name;  // of its column
  Scalar type;       // of its column
  std::size_t offset;
  std::uint8_t shift = 0, bits = 0;  // of a byte; bits 0: the whole value
  bool is_uint64 = false;            // as it is stored
};

// All but the coordinates, which are the first twelve bytes, in the order of their columns. `format`: 0
// to 10.
std::vector<LasField> las_fields(int format);

// The first byte of each group of fields that only some formats have.
struct LasGroups {
  std::optional<std::size_t> gps_time, colour, infrared, waveform;
};
inline constexpr std::size_t kLasTimeBytes = 8, kLasColourBytes = 6, kLasInfraredBytes = 2,
                             kLasWaveformBytes = 29;
LasGroups las_groups(int format);

// Formats 6 to 10 have larger fields for returns, class and scan angle.
constexpr bool is_extended_format(int format) {
  return format >= 6;
}

// The smallest format that has the groups; infrared comes with colours, and only with extended fields.
int las_format_with(bool is_extended, bool has_time, bool has_colour, bool has_infrared, bool has_waveform);

}  // namespace lacuna::io
