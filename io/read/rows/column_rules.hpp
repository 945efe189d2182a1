// SPDX-License-Identifier: Apache-2.0
// Which columns of a table are x, y and z, for formats whose columns may have any name, or none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

// What names say of the position: nothing, lengths, or longitude and latitude.
enum class PositionNames : std::uint8_t { kNone, kLengths, kDegrees };

// Renames the columns of the position to x, y and z, if exactly one choice is possible. The names x, y and z
// have priority. Names of the field follow, such as Easting, Northing, Height or X_m, then lon and lat.
PositionNames name_position(std::vector<std::string>& names);

// Returns the column of times, by names such as gps_time, Timestamp or "GPS Time (s)". gps_time has priority.
std::optional<std::size_t> find_time(std::span<const std::string> names);

// Whether a name begins as one of longitude or latitude does.
bool is_name_of_degrees(std::string_view name);

// Whether at least two of the names begin as names of a position do, such as LATITUDE_LOW.
bool name_some_position(std::span<const std::string> names);

// The first rows of a table, row by row.
struct SampledRows {
  std::size_t columns = 0;
  std::vector<double> values;

  std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
  double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

// Says why the first three columns without names may not be x, y and z; empty: nothing speaks against it.
// Fewer than ten rows say nothing.
std::string doubt_of_first_columns(const SampledRows& rows);

}  // namespace lacuna::io
