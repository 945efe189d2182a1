// SPDX-License-Identifier: Apache-2.0
// The lines of a text file: the cells of one, and where the first ones have the header and the rows.
#pragma once

#include "io/read/files/input_file.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

// A line of a text file as cells.

using Cells = std::vector<std::string_view>;

// Like next_field (io/read/files/number.hpp), but quotes are no part of the cell, and separators within them
// are.
bool next_cell(std::string_view& rest, char separator, std::string_view& cell);
Cells split(std::string_view line, char separator);

// Returns what divides the cells of a line. Commas do, unless a blank is left between two numbers. Then the
// commas are decimal commas. Tabs do where words have blanks within.
char find_separator(std::string_view line);

// Divides a line by its own separator.
Cells cells_of(std::string_view line);

// Takes a plain number and one separator behind it, in a single pass over its characters: fast, for most
// cells. Returns false and takes nothing where anything else follows, such as quotes or blanks before a
// comma.
bool take_number(std::string_view& rest, char separator, double& value);

// Reads a number as any program writes it. Returns false for other text.
bool parse_cell(std::string_view cell, double& value);
std::size_t count_numbers(const Cells& cells);
// Whether the text is a number, or meant to be one.
bool is_numeric(std::string_view cell);
// Whether the text is one of the words that programs write for a value that is not there.
bool is_missing(std::string_view cell);

bool is_comment(std::string_view line);
std::string_view without_blanks(std::string_view line);  // at its beginning
std::string_view without_end(std::string_view line);     // without blanks at its end

// The first lines of a text file, and where its header and its rows are.

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
