// SPDX-License-Identifier: Apache-2.0
#include "io/read/text/text_columns.hpp"

#include "io/read/rows/column_rules.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "io/read/text/split_numbers.hpp"
#include "io/read/text/text_cells.hpp"
#include "io/read/text/text_start.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

namespace lacuna::io {
namespace {

constexpr const char* kAllowed = "rows of numbers divided by blanks, commas or semicolons are allowed";

std::vector<std::string> default_names(std::size_t count) {
  std::vector<std::string> names = {"x", "y", "z"};
  while (names.size() < count) names.push_back("column_" + std::to_string(names.size() + 1));
  return names;
}

// PTS files have the number of points on a line of its own, then as many rows. Returns nothing for other
// rows.
std::vector<std::string> pts_names(std::size_t count) {
  if (count == 4) return {"x", "y", "z", "intensity"};
  if (count == 6) return {"x", "y", "z", "red", "green", "blue"};
  if (count == 7) return {"x", "y", "z", "intensity", "red", "green", "blue"};
  return {};
}

// Returns the place of a name; their number without it.
std::size_t place_of(std::string_view name, const std::vector<std::string>& names) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

bool has_position(const std::vector<std::string>& names) {
  return std::max({place_of("x", names), place_of("y", names), place_of("z", names)}) < names.size();
}

constexpr std::string_view kMore = "...";  // the last name, where rows may have more values

class ColumnFinder {
 public:
  explicit ColumnFinder(InputFile& in) : in_(in) {}

  TextColumns find(std::string_view option) {
    const TextStart start = read_start(in_);
    const TextPlaces places = find_places(start.lines);
    const std::vector<Line> rows(
        start.lines.begin() + static_cast<std::ptrdiff_t>(std::min(places.row, start.lines.size())),
        start.lines.end());
    if (start.lines.empty() && start.count != std::uint64_t{0})
      in_.fail_at_line(in_.line(), std::string("the file ends here without a row; ") + kAllowed);
    columns_.block_rows = start.count;
    for (std::size_t i = 0; i < std::min(places.row, start.lines.size()); ++i)
      columns_.lines_before.emplace_back(without_end(start.lines[i].text));
    const std::string_view header_line =
        places.header ? std::string_view(start.lines[*places.header].text) : std::string_view();
    const Cells header = header_cells(header_line);
    const std::string_view first = rows.empty() ? std::string_view() : std::string_view(rows[0].text);
    const Cells cells = first_cells(first, header_line, header);
    if (std::max(cells.size(), header.size()) > kMostColumns) in_.fail_at_line(in_.line(), kTooManyColumns);
    columns_.names = find_names(start, places, header, cells, option);
    name_rows(columns_.names, rows);
    check_names();
    if (places.row == 0) {
      columns_.first_row = first;
    } else {
      const std::uint64_t before_rows = rows.empty() ? start.lines.back().number : rows[0].number - 1;
      while (in_.line() < before_rows) in_.next_line();
    }
    return std::move(columns_);
  }

 private:
  // Returns the cells of the first row. A header may be divided by something else than the rows.
  Cells first_cells(std::string_view row, std::string_view header_line, const Cells& header) {
    columns_.separator = find_separator(row);
    Cells cells = split(row, columns_.separator);
    if (header.empty() || cells.size() == header.size()) return cells;
    const char of_header = find_separator(header_line);
    const Cells others = split(row, of_header);
    if (others.size() != header.size()) return cells;
    columns_.separator = of_header;
    return others;
  }

  std::vector<std::string> find_names(const TextStart& start, const TextPlaces& places, const Cells& header,
                                      const Cells& cells, std::string_view option) {
    const Cells given = split(option, ' ');
    const bool is_mapping = option.find('=') != option.npos;
    if (!given.empty() && !is_mapping) return column_names(given);
    std::vector<std::string> names =
        header.empty() ? commented_names(start, cells, is_mapping) : column_names(header);
    if (is_mapping) {
      if (names.empty())
        in_.fail_at_line(in_.line(), "no header line; names of columns can be given only in their order");
      return mapped_names(std::move(names), given);
    }
    if (!names.empty()) return names;
    if (places.row > 0)
      in_.fail_at_line(
          start.lines[0].number,
          in_quotes(start.lines[0].text) +
              " is neither a header line with x, y and z nor a row; --columns x,y,z says what the "
              "columns are, and rows begin with the first line of numbers");
    if (!cells.empty() && cells.size() < 3)
      in_.fail_at_line(in_.line(), std::to_string(cells.size()) + " values; at least x y z are needed");
    is_unnamed_ = true;
    if (start.count && !pts_names(cells.size()).empty()) {
      is_unnamed_ = false;
      return pts_names(cells.size());
    }
    return default_names(cells.size());
  }

  // Returns the names in a comment before the first row; empty if no comment has names for its columns. A
  // list at the end, as in COLMAP's points3D.txt, becomes "...".
  std::vector<std::string> commented_names(const TextStart& start, const Cells& cells, bool any) {
    for (auto comment = start.comments.rbegin(); comment != start.comments.rend(); ++comment) {
      const bool has_list = comment->find("[]") != comment->npos;
      const Cells whole =
          comment_cells(std::string_view(*comment).substr(0, has_list ? comment->find('[') : comment->npos));
      if (has_list && names_position(whole) && whole.size() <= cells.size() + 1) {
        std::vector<std::string> names = column_names(whole);
        names.back() = kMore;
        return names;
      }
      std::vector<std::string> names = column_names(whole);
      if (names.size() == cells.size() && (any || names_position(whole) || name_some_position(names)))
        return names;
      std::vector<std::string> found = names;
      if (names.size() == cells.size() || name_position(found) == PositionNames::kNone) continue;
      const std::size_t x = place_of("x", found), y = place_of("y", found), z = place_of("z", found);
      const bool is_at_start = x == 0 && y == 1 && z == 2;
      if (is_at_start || std::max({x, y, z}) >= cells.size()) continue;
      in_.fail_at_line(in_.line(), "the row has " + std::to_string(cells.size()) +
                                       " values, and the comment before it names " +
                                       std::to_string(names.size()) + " columns: " + joined(names) +
                                       "; --columns says what the columns are, such as --columns id,x,y,z");
    }
    return {};
  }

  // Names from a header, some of them replaced: "x=Easting" makes the column Easting x.
  std::vector<std::string> mapped_names(std::vector<std::string> names, const Cells& given) {
    for (const std::string_view word : given) {
      const std::size_t equals = word.find('=');
      const std::string from(equals == word.npos ? std::string_view() : word.substr(equals + 1));
      const auto found = std::find(names.begin(), names.end(), from);
      if (from.empty() || found == names.end()) {
        in_.fail_at_line(in_.line(),
                         "no column for " + in_quotes(word) + "; the columns are " + joined(names));
      }
      *found = column_name(word.substr(0, equals), 0);
      columns_.are_degrees =
          columns_.are_degrees || (is_name_of_degrees(from) && (*found == "x" || *found == "y"));
    }
    return names;
  }

  // Makes the columns of the names, but those that have words, which are not read.
  void name_rows(std::vector<std::string>& names, const std::vector<Line>& lines) {
    if (!names.empty() && names.back() == kMore) {
      columns_.has_more = true;
      names.pop_back();
    }
    const PositionNames position = name_position(names);
    if (position == PositionNames::kNone && !has_position(names))
      in_.fail_at_line(in_.line(), "no columns named x, y and z, but " + joined(names) +
                                       "; --columns x=...,y=...,z=... says which they are");
    columns_.are_degrees = columns_.are_degrees || position == PositionNames::kDegrees;
    const SampledRows rows = sample(names, lines);
    if (is_unnamed_) {
      refuse_matrix(rows);
      if (const std::string doubt = doubt_of_split_numbers(lines, columns_.separator); !doubt.empty())
        in_.fail_at_line(in_.line(), doubt + ", in " + in_quotes(lines[0].text) +
                                         " first; the program that wrote them can divide values by "
                                         "semicolons, and --columns x,y,z,a,b,c says that they are columns");
      if (const std::string doubt = doubt_of_first_columns(rows); !doubt.empty())
        in_.fail_at_line(in_.line(), "no header line, and " + doubt + ", in " + in_quotes(lines[0].text) +
                                         " first; --columns says what the columns are, such as --columns "
                                         "id,x,y,z or --columns x,y,z,a");
    }
  }

  void refuse_matrix(const SampledRows& rows) {
    if (!is_matrix(rows)) return;
    const std::uint64_t line = in_.line();
    std::uint64_t count = 1;
    while (const auto next = in_.next_line()) {
      const std::string_view text = without_blanks(*next);
      count += text.empty() || is_comment(text) ? 0 : 1;
    }
    in_.fail_at_line(line, describe_matrix(count, rows.columns));
  }

  // Reads the sampled lines that have a value for each column, and marks columns with words as not read.
  SampledRows sample(std::vector<std::string>& names, const std::vector<Line>& lines) const {
    SampledRows rows{.columns = names.size(), .values = {}, .decimals = {}};
    constexpr std::size_t kMostValues = std::size_t{1} << 16;
    for (const Line& line : lines) {
      if (rows.values.size() >= kMostValues) break;
      const Cells cells = split(line.text, columns_.separator);
      if (cells.size() < names.size() || (cells.size() > names.size() && !columns_.has_more)) continue;
      const bool is_first = rows.values.empty();
      rows.decimals.resize(names.size());
      for (std::size_t i = 0; i < names.size(); ++i) {
        const std::size_t decimals = cells[i].size() - std::min(cells[i].find('.') + 1, cells[i].size());
        if (is_first) rows.decimals[i] = decimals;
        if (rows.decimals[i] != decimals) rows.decimals[i].reset();
        double value = std::numeric_limits<double>::quiet_NaN();
        if (!parse_cell(cells[i], value) && !is_missing(cells[i]) && names[i] != "x" && names[i] != "y" &&
            names[i] != "z")
          names[i] = kNotRead;
        rows.values.push_back(value);
      }
    }
    return rows;
  }

  void check_names() const {
    std::set<std::string> seen;
    for (const std::string& name : columns_.names) {
      if (name != kNotRead && !seen.insert(name).second)
        in_.fail_at_line(in_.line(), "a second column " + in_quotes(name) + "; names must differ");
    }
  }

  InputFile& in_;
  TextColumns columns_;
  bool is_unnamed_ = false;  // the columns have names by their order alone
};

}  // namespace

TextColumns find_text_columns(InputFile& in, std::string_view given) {
  return ColumnFinder(in).find(given);
}

}  // namespace lacuna::io
