// SPDX-License-Identifier: Apache-2.0
// A line of a text file as cells.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace lacuna::io {

using Cells = std::vector<std::string_view>;

// Like next_field (io/read/files/number.hpp), but quotes are no part of the cell, and separators within them are.
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

}  // namespace lacuna::io
