// SPDX-License-Identifier: Apache-2.0
#include "io/read/text/text_cells.hpp"

#include "io/read/files/number.hpp"

#include <algorithm>
#include <charconv>
#include <string>

namespace lacuna::io {
namespace {

bool is_number(std::string_view cell) {
  double value;
  return parse_cell(cell, value);
}

// Takes the text between quotes, whose first one begins `cell`. `line` is what was left before the cell.
void take_quoted(std::string_view line, char separator, std::string_view& rest, std::string_view& cell) {
  const std::size_t begin = static_cast<std::size_t>(cell.data() - line.data()) + 1;
  const std::size_t end = line.find('"', begin);
  if (end == line.npos) return;
  rest = line.substr(end + 1);
  std::string_view behind;
  if (separator != ' ') next_field(rest, separator, behind);
  cell = line.substr(begin, end - begin);
  while (!cell.empty() && cell.front() == ' ') cell.remove_prefix(1);
  while (!cell.empty() && cell.back() == ' ') cell.remove_suffix(1);
}

std::string without_quoted(std::string_view line) {
  std::string text;
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') is_quoted = !is_quoted;
    if (!is_quoted) text += c;
  }
  return text;
}

}  // namespace

bool next_cell(std::string_view& rest, char separator, std::string_view& cell) {
  const std::string_view line = rest;
  if (!next_field(rest, separator, cell)) return false;
  if (cell.starts_with('"')) take_quoted(line, separator, rest, cell);
  return true;
}

Cells split(std::string_view line, char separator) {
  Cells cells;
  for (std::string_view cell; next_cell(line, separator, cell);) cells.push_back(cell);
  return cells;
}

bool take_number(std::string_view& rest, char separator, double& value) {
  const char *begin = rest.data(), *const end = begin + rest.size();
  while (begin != end && (*begin == ' ' || *begin == '\t')) ++begin;
  const auto [stop, status] = std::from_chars(begin, end, value);
  if (status != std::errc{}) return false;
  if (stop != end && *stop != separator && !(separator == ' ' && (*stop == '\t' || *stop == '\r')))
    return false;
  rest.remove_prefix(static_cast<std::size_t>(stop - rest.data()) + (stop == end ? 0 : 1));
  return true;
}

bool parse_cell(std::string_view cell, double& value) {
  return parse_number(cell, value) || parse_foreign_number(cell, value);
}

std::size_t count_numbers(const Cells& cells) {
  return static_cast<std::size_t>(std::count_if(cells.begin(), cells.end(), is_number));
}

bool is_missing(std::string_view cell) {
  for (const char* word : {"", "NA", "N/A", "null", "NULL", "None", "\\N"}) {
    if (cell == word) return true;
  }
  return false;
}

char find_separator(std::string_view given) {
  const std::string line = without_quoted(given);
  if (line.find(';') != line.npos) return ';';
  const auto has_blanks_between = [&](char separator, bool numbers) {
    const Cells cells = split(line, separator);
    return std::any_of(cells.begin(), cells.end(), [&](std::string_view cell) {
      const Cells words = split(cell, ' ');
      return words.size() > 1 && (count_numbers(words) == words.size()) == numbers;
    });
  };
  if (line.find(',') != line.npos) return has_blanks_between(',', true) ? ' ' : ',';
  return line.find('\t') != line.npos && has_blanks_between('\t', false) ? '\t' : ' ';
}

Cells cells_of(std::string_view line) {
  return split(line, find_separator(line));
}

std::string_view without_blanks(std::string_view line) {
  const std::size_t begin = std::min(line.find_first_not_of(" \t\r\v\f"), line.size());
  return line.substr(begin);
}

std::string_view without_end(std::string_view line) {
  return line.substr(0, line.find_last_not_of(" \t\r\v\f") + 1);
}

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with("//");
}

bool is_numeric(std::string_view cell) {
  return is_number(cell) || (!cell.empty() && cell.find_first_of("0123456789+-.") == 0);
}

}  // namespace lacuna::io
