// SPDX-License-Identifier: Apache-2.0
#include "io/read/text/text_lines.hpp"

#include "io/read/files/number.hpp"
#include "io/read/rows/column_rules.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <algorithm>
#include <charconv>

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

namespace {

constexpr std::size_t kSampleBytes = std::size_t{1} << 20;
constexpr std::size_t kSampleLines = 4096;

// A file whose lines end with a carriage return alone is one line for this reader.
void refuse_lone_returns(const InputFile& in, std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.find('\r') != std::string_view::npos)
    in.fail_at_line(in.line(), "a carriage return within the line; lines must end with LF or with CR and LF");
}

void read_first_line(InputFile& in, TextStart& start) {
  constexpr std::size_t kMostComments = 64;
  if (in.peek(3) == "\xef\xbb\xbf") in.skip(3);  // byte order mark of UTF-8
  while (const auto line = in.next_line()) {
    refuse_lone_returns(in, *line);
    const std::string_view text = without_blanks(*line);
    std::uint64_t count = 0;
    const Cells words = split(text, ' ');
    if (words.empty()) continue;
    if (is_comment(text)) {
      if (start.comments.size() == kMostComments) start.comments.erase(start.comments.begin());
      start.comments.emplace_back(text.substr(std::min(text.find_first_not_of("#/"), text.size())));
    } else if (!start.count && words.size() == 1 && parse_number(words[0], count)) {
      start.count = count;
    } else {
      start.lines.push_back({in.line(), std::string(text)});
      break;
    }
  }
}

// Adds lines behind the first without passing them. A last line that may be cut is left out.
void sample_lines(InputFile& in, TextStart& start) {
  std::string_view others = in.peek(kSampleBytes);
  const bool is_whole = others.size() == in.remaining();
  for (std::uint64_t number = in.line() + 1; !others.empty() && start.lines.size() < kSampleLines; ++number) {
    const std::size_t end = others.find('\n');
    if (end == others.npos && !is_whole) return;
    const std::string_view text = without_end(without_blanks(others.substr(0, end)));
    others.remove_prefix(end == others.npos ? others.size() : end + 1);
    if (!text.empty() && !is_comment(text)) start.lines.push_back({number, std::string(text)});
  }
}

}  // namespace

std::string column_name(std::string_view cell, std::size_t index) {
  if (cell.empty()) return "column_" + std::to_string(index + 1);
  return property_name(cell);
}

std::vector<std::string> column_names(const Cells& cells) {
  std::vector<std::string> names;
  for (const std::string_view cell : cells) names.push_back(column_name(cell, names.size()));
  return names;
}

Cells header_cells(std::string_view line) {
  const char separator = find_separator(line);
  Cells cells = split(line, separator);
  if (separator == ' ')
    std::erase_if(cells, [](std::string_view cell) {
      return cell.size() > 1 && (cell.front() == '(' || cell.front() == '[');
    });
  return cells;
}

Cells comment_cells(std::string_view comment) {
  Cells cells = header_cells(comment);
  if (!cells.empty() && cells[0].ends_with(':')) cells.erase(cells.begin());
  return cells;
}

std::string joined(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i)
    text += (i > 0 ? ", " : "") + in_quotes(names[i]);
  return text + (names.size() > kMost ? ", ..." : "");
}

bool names_position(const Cells& cells) {
  std::vector<std::string> names = column_names(cells);
  return name_position(names) != PositionNames::kNone;
}

TextStart read_start(InputFile& in) {
  TextStart start;
  read_first_line(in, start);
  if (!start.lines.empty()) sample_lines(in, start);
  return start;
}

TextPlaces find_places(const std::vector<Line>& lines) {
  constexpr std::size_t kMostBefore = 200;
  const auto row_behind = [&](std::size_t i) {
    const bool is_unit_line = i + 2 < lines.size() && count_numbers(cells_of(lines[i + 1].text)) == 0 &&
                              count_numbers(cells_of(lines[i + 2].text)) >= 3;
    return i + (is_unit_line ? 2 : 1);
  };
  for (std::size_t i = 0; i < std::min(lines.size(), kMostBefore); ++i) {
    const Cells names = header_cells(lines[i].text);
    const Cells cells = cells_of(lines[i].text);
    if (names_position(names)) {
      const std::size_t row = row_behind(i);
      const auto fits = [&](char separator) {
        return split(lines[row].text, separator).size() == names.size();
      };
      if (i == 0 || row >= lines.size() || fits(find_separator(lines[row].text)) ||
          fits(find_separator(lines[i].text)))
        return {i, row};
    }
    if (count_numbers(cells) < 3) continue;
    if (i > 0 && std::none_of(cells.begin(), cells.end(), is_missing)) {
      const Cells before = header_cells(lines[i - 1].text);
      if (before.size() == cells.size() && std::none_of(before.begin(), before.end(), is_numeric))
        return {i - 1, i};
    }
    return {std::nullopt, i};
  }
  if (lines.empty()) return {};
  const Cells first = header_cells(lines[0].text);
  if (std::none_of(first.begin(), first.end(), is_numeric)) return {0, 1};
  return {};
}

}  // namespace lacuna::io
