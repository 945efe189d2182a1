// SPDX-License-Identifier: Apache-2.0
// What the beginning of a text file says of its rows.
#pragma once

#include "io/files/input_file.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

using Fields = std::vector<std::string_view>;
Fields split(std::string_view line, char separator);
// Returns the field without the quotes around it.
std::string_view unquoted(std::string_view field);

std::string_view without_blanks(std::string_view line);  // at its beginning
bool is_comment(std::string_view line);
bool parse_value(std::string_view field, double& value);

struct TextColumns {
  std::vector<std::string> names;           // x, y and z are among them
  bool has_list = false;                    // a row may have any number of values behind the columns
  bool are_degrees = false;                 // x and y are longitude and latitude
  char separator = ' ';                     // of the rows
  std::uint64_t lines_before = 0;           // the first row
  std::optional<std::uint64_t> block_rows;  // a line before the rows counts them (.pts)
};

// Looks at the first lines. The first row is the first line with three numbers. Its columns are named by
// `given`, else by the line before it, else by a comment before it. Without names, the columns are x, y, z,
// column_4 and so on. Names of the field stand for x, y and z: easting, northing, height and the like.
// `given`: names in order, or words such as "x=Easting", which name a column of the header anew.
// Throws `Error` where no column is x, y or z, and where unnamed columns are probably something else. Such
// columns count the rows, hold whole numbers before three that do not, or repeat another one. Cost: the first
// MiB.
TextColumns find_text_columns(InputFile& in, std::string_view given);

}  // namespace lacuna::io
