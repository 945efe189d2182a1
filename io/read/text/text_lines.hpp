// SPDX-License-Identifier: Apache-2.0
// The first lines of a text file, and where its header and its rows are.
#pragma once

#include "io/read/files/input_file.hpp"
#include "io/read/text/text_cells.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

struct Line {
  std::uint64_t number;
  std::string text;
};

// The first lines of a file without blank lines.
struct TextStart {
  std::vector<std::string> comments;   // before the first line, without their signs
  std::optional<std::uint64_t> count;  // on a line of its own
  std::vector<Line> lines;             // the first line that is neither, and some behind it
};

// Passes the lines up to the first one that is neither a comment nor a count.
TextStart read_start(InputFile& in);

// Where the header and the rows begin, as indices of lines.
struct TextPlaces {
  std::optional<std::size_t> header;
  std::size_t row = 0;
};

// Searches the lines before the first row for a header. Text may come before it, and a line of units behind.
TextPlaces find_places(const std::vector<Line>& lines);

// Returns the cells of a header. Where blanks divide them, a unit in brackets belongs to the name before.
Cells header_cells(std::string_view line);
// Returns the cells of a comment that may be a header, such as "columns: x y z".
Cells comment_cells(std::string_view comment);
std::string column_name(std::string_view cell, std::size_t index);
std::vector<std::string> column_names(const Cells& cells);
std::string joined(const std::vector<std::string>& names);  // in quotes, the first twelve of them
bool names_position(const Cells& cells);                    // name_position (io/read/rows/column_rules.hpp)

}  // namespace lacuna::io
