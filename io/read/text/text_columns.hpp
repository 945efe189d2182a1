// SPDX-License-Identifier: Apache-2.0
// What the first lines of a text file say of its rows.
#pragma once

#include "io/read/files/input_file.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

// The name of a column that is not read.
inline constexpr const char* kNotRead = "_";

struct TextColumns {
  std::vector<std::string> names;           // in the order of the file; x, y and z are among them
  bool has_more = false;                    // rows may have more values than names
  bool are_degrees = false;                 // x and y are longitude and latitude
  char separator = ' ';                     // of the rows
  std::optional<std::uint64_t> block_rows;  // a line before the rows counts them (.pts)
  std::vector<std::string> lines_before;    // the rows, the header among them
  std::string first_row;  // if it was passed; else the next line is the first row, or a comment
};

// Passes the lines before the rows. open_text (io/read/text/text_reader.hpp) says how columns get their names.
// `given`: the option for them. Throws `Error` where there is no row or header, and where no column is x, y
// or z, or may not be. Cost: 4,096 lines.
TextColumns find_text_columns(InputFile& in, std::string_view given);

}  // namespace lacuna::io
