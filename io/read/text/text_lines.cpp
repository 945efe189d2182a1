// SPDX-License-Identifier: Apache-2.0
#include "io/read/text/text_start.hpp"

#include "io/read/files/number.hpp"
#include "io/read/files/property_name.hpp"
#include "io/read/rows/column_rules.hpp"

#include <algorithm>

namespace lacuna::io {
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
