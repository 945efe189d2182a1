// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/input_file.hpp"
#include "io/read/files/number.hpp"
#include "io/read/rows/column_rules.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/readers.hpp"
#include "io/read/text/text_lines.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

// Whether the digits before the decimals begin with a zero that no number needs.
bool has_leading_zero(std::string_view cell) {
  return cell.size() > 1 && cell[0] == '0' && cell[1] >= '0' && cell[1] <= '9';
}

// Says why values of rows without names may be parts of numbers; empty: nothing speaks for it. Commas may
// divide values and begin decimals, as in "500000,053,5400000,363". Commas and blanks may divide values and
// thousands, as in "500 000.25 5 400 000.36". A part of three digits or more that begins with a zero says so.
std::string doubt_of_split_numbers(std::span<const Line> rows, char separator) {
  constexpr std::string_view kDigits = "0123456789";
  constexpr std::size_t kFewestParts = 5;  // of x y z, one of which has no decimals
  if (separator != ',' && separator != ' ') return {};
  for (const Line& row : rows) {
    const Cells cells = split(row.text, separator);
    const bool are_whole =
        cells.size() >= kFewestParts && std::ranges::all_of(cells, [](std::string_view cell) {
          return cell.find_first_not_of("+-0123456789") == cell.npos;
        });
    for (std::size_t i = 1; i < cells.size(); ++i) {
      const std::string_view before = cells[i - 1].substr(cells[i - 1].starts_with('-') ? 1 : 0);
      const std::size_t digits = std::min(cells[i].find_first_not_of(kDigits), cells[i].size());
      if (!has_leading_zero(cells[i]) || before.find_first_not_of(kDigits) != before.npos) continue;
      if (separator == ',' && are_whole) return "commas divide the values, and may begin their decimals, too";
      if (digits == 3 && before.size() <= 3)
        return std::string(separator == ',' ? "commas" : "blanks") +
               " divide the values, and may divide the thousands of numbers, too";
    }
  }
  return {};
}

// What the first lines of a text file say of its rows.

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
    constexpr std::size_t kMostUnnamed = 20;  // a matrix of heights or depths has more
    if (cells.size() > kMostUnnamed)
      in_.fail_at_line(in_.line(),
                       std::to_string(cells.size()) +
                           " columns without names, as a matrix of heights has; points need x y z, "
                           "such as `gdal_translate -of XYZ` makes of a raster; --columns x,y,z,... "
                           "says that the first columns are these");
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

  // Reads the sampled lines that have a value for each column, and marks columns with words as not read.
  SampledRows sample(std::vector<std::string>& names, const std::vector<Line>& lines) const {
    SampledRows rows{.columns = names.size(), .values = {}};
    constexpr std::size_t kMostValues = std::size_t{1} << 16;
    for (const Line& line : lines) {
      if (rows.values.size() >= kMostValues) break;
      const Cells cells = split(line.text, columns_.separator);
      if (cells.size() < names.size() || (cells.size() > names.size() && !columns_.has_more)) continue;
      for (std::size_t i = 0; i < names.size(); ++i) {
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

// Passes the lines before the rows. open_text (io/read/rows/readers.hpp) says how columns get their
// names. `given`: the option for them. Throws `Error` where there is no row or header, and where no column is
// x, y or z, or may not be. Cost: 4,096 lines.
TextColumns find_text_columns(InputFile& in, std::string_view given) {
  return ColumnFinder(in).find(given);
}

class TextReader final : public ScanReader {
 public:
  TextReader(const std::filesystem::path& file, const ReadOptions& options)
      : in_(file), columns_(find_text_columns(in_, options.columns)), block_rows_(columns_.block_rows) {
    std::vector<std::pair<std::string, Scalar>> columns;
    for (const std::string& name : columns_.names) {
      is_read_.push_back(name != kNotRead);
      if (is_read_.back()) columns.emplace_back(name, Scalar::kFloat64);
    }
    layout_ = packed_layout(columns);
  }

  std::string format() const override { return "text"; }
  const RowLayout& layout() const override { return layout_; }
  bool is_geographic() const override { return columns_.are_degrees; }
  RowFindings findings() const override { return findings_; }

  // A file of counted rows may have more such blocks behind the first.
  std::optional<std::uint64_t> expected_rows() const override { return std::nullopt; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    const bool has_rows = fill_batch(batch, max_rows, layout_.stride, [&](std::byte* to) {
      if (!columns_.first_row.empty()) {
        put_row(std::exchange(columns_.first_row, {}), to);
        return true;
      }
      while (const auto line = in_.next_line()) {
        const std::string_view text = without_blanks(*line);
        if (text.empty() || is_comment(text) || begins_block(text) || is_repeated(text)) continue;
        put_row(text, to);
        return true;
      }
      return false;
    });
    if (!has_rows && block_rows_ && rows_ < *block_rows_)
      fail_number_of_rows("the file ends here with fewer");
    return has_rows;
  }

 private:
  // Files that were joined have their headers within.
  bool is_repeated(std::string_view line) {
    const bool is_one =
        std::ranges::find(columns_.lines_before, without_end(line)) != columns_.lines_before.end();
    findings_.repeated_lines += is_one ? 1 : 0;
    return is_one;
  }

  // Reads, in a file of counted rows, a bare count behind the rows of a block. Exports of several stations
  // have such counts.
  bool begins_block(std::string_view line) {
    std::uint64_t count = 0;
    if (rows_ != block_rows_ || !parse_number(without_end(line), count)) return false;
    block_rows_ = count;
    rows_ = 0;
    return true;
  }

  void put_row(std::string_view rest, std::byte* to) {
    if (rows_ == block_rows_) fail_number_of_rows("more");
    ++rows_;
    const std::string_view row = rest;
    std::string_view cell;
    for (std::size_t i = 0; i < is_read_.size(); ++i) {
      double value;
      if (is_read_[i] && take_number(rest, columns_.separator, value)) {
        store_next(to, value);
        continue;
      }
      if (!next_cell(rest, columns_.separator, cell)) {
        // No field follows a last separator, but an empty cell does.
        if (i + 1 < is_read_.size() || i == 0 || columns_.separator == ' ' ||
            without_end(row).back() != columns_.separator)
          fail_number_of_values("fewer");
        cell = {};
      }
      if (!is_read_[i]) continue;
      if (!parse_cell(cell, value)) {
        if (!is_missing(cell)) fail_number(cell, row);
        value = std::numeric_limits<double>::quiet_NaN();
      }
      store_next(to, value);
    }
    if (!columns_.has_more && next_cell(rest, columns_.separator, cell)) fail_number_of_values("more");
  }

  // Whether signs divide the digits of a number; bytes above 127 are of blanks and quotes.
  static bool has_thousands(std::string_view cell) {
    constexpr std::string_view kBetween = ".,' \xa0\x80",
                               kOthers = "0123456789+-.,' \xa0\x80\xc2\xe2\xaf\x99";
    const std::size_t first = cell.find_first_of(kBetween);
    return first != cell.npos && first > 0 && cell.find_first_not_of(kOthers) == cell.npos;
  }

  [[noreturn]] void fail_number(std::string_view cell, std::string_view row) const {
    const bool is_header = count_numbers(split(row, columns_.separator)) == 0;
    in_.fail_at_line(
        in_.line(),
        in_quotes(cell) + " is not a number" +
            (has_thousands(cell) ? "; thousands must not be divided"
             : is_header ? ", and no value of its line is; joined files with other columns must be read "
                           "one by one"
                         : "; --columns leaves a column out that has the name _, such as --columns x,y,z,_"));
  }

  [[noreturn]] void fail_number_of_values(const std::string& comparison) const {
    in_.fail_at_line(in_.line(), comparison + " values than the " + std::to_string(is_read_.size()) +
                                     " columns; every row must have one for each");
  }

  [[noreturn]] void fail_number_of_rows(const std::string& comparison) const {
    in_.fail_at_line(in_.line(), comparison + " rows than the " + std::to_string(*block_rows_) +
                                     " that a line before them declares");
  }

  InputFile in_;
  TextColumns columns_;
  RowLayout layout_;
  std::vector<char> is_read_;                // of each column of the file
  std::optional<std::uint64_t> block_rows_;  // of the current block, where its rows are counted
  std::uint64_t rows_ = 0;                   // of it so far
  RowFindings findings_;
};

}  // namespace

bool looks_like_text(const FileStart& start) {
  return start.first_bytes.find('\0') == std::string_view::npos;
}

std::unique_ptr<ScanReader> open_text(const std::filesystem::path& file, const ReadOptions& options) {
  return std::make_unique<TextReader>(file, options);
}

}  // namespace lacuna::io
