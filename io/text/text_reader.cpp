// SPDX-License-Identifier: Apache-2.0
#include "io/text/text_reader.hpp"

#include "io/files/input_file.hpp"
#include "io/files/number.hpp"
#include "io/files/property_name.hpp"
#include "io/rows/column_rules.hpp"
#include "io/rows/scalar.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

namespace lacuna::io {
namespace {

constexpr const char* kAllowed = "rows of numbers divided by blanks, commas or semicolons are allowed";

using Fields = std::vector<std::string_view>;

// Takes the text between quotes, whose first one begins `field`. `line` is what was left before the field.
void take_quoted(std::string_view line, char separator, std::string_view& rest, std::string_view& field) {
  const std::size_t begin = static_cast<std::size_t>(field.data() - line.data()) + 1;
  const std::size_t end = line.find('"', begin);
  if (end == line.npos) return;
  rest = line.substr(end + 1);
  std::string_view behind;
  if (separator != ' ') next_field(rest, separator, behind);
  field = line.substr(begin, end - begin);
  while (!field.empty() && field.front() == ' ') field.remove_prefix(1);
  while (!field.empty() && field.back() == ' ') field.remove_suffix(1);
}

// Like next_field, but quotes are no part of the field, and separators within them are.
bool next_cell(std::string_view& rest, char separator, std::string_view& field) {
  const std::string_view line = rest;
  if (!next_field(rest, separator, field)) return false;
  if (field.starts_with('"')) take_quoted(line, separator, rest, field);
  return true;
}

Fields split(std::string_view line, char separator) {
  Fields fields;
  for (std::string_view field; next_cell(line, separator, field);) fields.push_back(field);
  return fields;
}

bool is_number(std::string_view field) {
  double value;
  return parse_number(field, value) || parse_foreign_number(field, value);
}

std::size_t count_numbers(const Fields& fields) {
  return static_cast<std::size_t>(std::count_if(fields.begin(), fields.end(), is_number));
}

// Words of other programs for a value that is not there.
bool is_missing(std::string_view field) {
  for (const char* word : {"", "NA", "N/A", "null", "NULL", "None", "\\N"}) {
    if (field == word) return true;
  }
  return false;
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

// Commas divide values, unless a blank is left between two numbers. Then the commas are decimal commas. Tabs
// divide where words have blanks within.
char find_separator(std::string_view given) {
  const std::string line = without_quoted(given);
  if (line.find(';') != line.npos) return ';';
  const auto has_blanks_between = [&](char separator, bool numbers) {
    const Fields fields = split(line, separator);
    return std::any_of(fields.begin(), fields.end(), [&](std::string_view field) {
      const Fields words = split(field, ' ');
      return words.size() > 1 && (count_numbers(words) == words.size()) == numbers;
    });
  };
  if (line.find(',') != line.npos) return has_blanks_between(',', true) ? ' ' : ',';
  return line.find('\t') != line.npos && has_blanks_between('\t', false) ? '\t' : ' ';
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

// Whether the text is a number, or meant to be one.
bool is_numeric(std::string_view field) {
  return is_number(field) || (!field.empty() && field.find_first_of("0123456789+-.") == 0);
}

std::string column_name(std::string_view field, std::size_t index) {
  if (field.empty()) return "column_" + std::to_string(index + 1);
  return property_name(field);
}

std::vector<std::string> column_names(const Fields& fields) {
  std::vector<std::string> names;
  for (const std::string_view field : fields) names.push_back(column_name(field, names.size()));
  return names;
}

// The fields of a header. Where blanks divide them, a unit in brackets belongs to the name before.
Fields header_fields(std::string_view line) {
  const char separator = find_separator(line);
  Fields fields = split(line, separator);
  if (separator == ' ')
    std::erase_if(fields, [](std::string_view field) {
      return field.size() > 1 && (field.front() == '(' || field.front() == '[');
    });
  return fields;
}

// The fields of a comment that may be a header, such as "columns: x y z".
Fields comment_fields(std::string_view comment) {
  Fields fields = header_fields(comment);
  if (!fields.empty() && fields[0].ends_with(':')) fields.erase(fields.begin());
  return fields;
}

bool names_position(const Fields& fields) {
  std::vector<std::string> names = column_names(fields);
  return name_position(names) != PositionNames::kNone;
}

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

std::string joined(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i)
    text += (i > 0 ? ", " : "") + in_quotes(names[i]);
  return text + (names.size() > kMost ? ", ..." : "");
}

bool has_position(const std::vector<std::string>& names) {
  for (const char* needed : {"x", "y", "z"}) {
    if (std::find(names.begin(), names.end(), needed) == names.end()) return false;
  }
  return true;
}

constexpr std::size_t kSampleBytes = std::size_t{1} << 20;
constexpr std::size_t kSampleLines = 4096;
constexpr const char* kNotRead = "_";      // the name of a column that is left out
constexpr std::string_view kMore = "...";  // the last name, where rows may have more values

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
    const Fields words = split(text, ' ');
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

TextStart read_start(InputFile& in) {
  TextStart start;
  read_first_line(in, start);
  if (!start.lines.empty()) sample_lines(in, start);
  return start;
}

// Where the header and the rows begin, as indices of lines.
struct TextPlaces {
  std::optional<std::size_t> header;
  std::size_t row = 0;
};

// Searches the lines before the first row for a header. Text may come before it, and a line of units behind.
TextPlaces find_places(const std::vector<Line>& lines) {
  constexpr std::size_t kMostBefore = 200;
  const auto row_behind = [&](std::size_t i) {
    const bool is_unit_line = i + 2 < lines.size() &&
                              count_numbers(split(lines[i + 1].text, find_separator(lines[i + 1].text))) == 0 &&
                              count_numbers(split(lines[i + 2].text, find_separator(lines[i + 2].text))) >= 3;
    return i + (is_unit_line ? 2 : 1);
  };
  for (std::size_t i = 0; i < std::min(lines.size(), kMostBefore); ++i) {
    const Fields names = header_fields(lines[i].text);
    const Fields fields = split(lines[i].text, find_separator(lines[i].text));
    if (names_position(names)) {
      const std::size_t row = row_behind(i);
      const auto fits = [&](char separator) { return split(lines[row].text, separator).size() == names.size(); };
      if (i == 0 || row >= lines.size() || fits(find_separator(lines[row].text)) ||
          fits(find_separator(lines[i].text)))
        return {i, row};
    }
    if (count_numbers(fields) < 3) continue;
    if (i > 0 && std::none_of(fields.begin(), fields.end(), is_missing)) {
      const Fields before = header_fields(lines[i - 1].text);
      if (before.size() == fields.size() && std::none_of(before.begin(), before.end(), is_numeric))
        return {i - 1, i};
    }
    return {std::nullopt, i};
  }
  if (lines.empty()) return {};
  const Fields first = header_fields(lines[0].text);
  if (std::none_of(first.begin(), first.end(), is_numeric)) return {0, 1};
  return {};
}

class TextReader final : public ScanReader {
 public:
  TextReader(const std::filesystem::path& file, const ReadOptions& options) : in_(file) {
    const TextStart start = read_start(in_);
    const TextPlaces places = find_places(start.lines);
    const std::vector<Line> rows(start.lines.begin() + static_cast<std::ptrdiff_t>(
                                                           std::min(places.row, start.lines.size())),
                                 start.lines.end());
    if (start.lines.empty() && start.count != std::uint64_t{0})
      in_.fail_at_line(in_.line(), std::string("the file ends here without a row; ") + kAllowed);
    block_rows_ = start.count;
    const Fields header = places.header ? header_fields(start.lines[*places.header].text) : Fields();
    const std::string first = rows.empty() ? std::string() : rows[0].text;
    separator_ = find_separator(first);
    Fields cells = split(first, separator_);
    if (!header.empty() && cells.size() != header.size()) {
      const char of_header = find_separator(start.lines[*places.header].text);
      if (const Fields others = split(first, of_header); others.size() == header.size()) {
        separator_ = of_header;
        cells = others;
      }
    }
    if (std::max(cells.size(), header.size()) > kMostColumns) in_.fail_at_line(in_.line(), kTooManyColumns);
    std::vector<std::string> names = find_names(start, places, header, cells, options);
    name_rows(names, rows);
    if (places.row == 0) {
      pending_ = first;
      return;
    }
    const std::uint64_t before_rows = rows.empty() ? start.lines.back().number : rows[0].number - 1;
    while (in_.line() < before_rows) in_.next_line();
  }

  std::string format() const override { return "text"; }
  const RowLayout& layout() const override { return layout_; }
  bool is_geographic() const override { return is_geographic_; }

  // A file of counted rows may have more such blocks behind the first.
  std::optional<std::uint64_t> expected_rows() const override { return std::nullopt; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    assert(max_rows > 0);
    const std::size_t rows = std::min(max_rows, std::max<std::size_t>(1, kBatchBytes / layout_.stride));
    batch.bytes.resize(rows * layout_.stride);
    batch.count = 0;
    if (!pending_.empty()) {
      add_row(pending_, batch);
      pending_.clear();
    }
    while (batch.count < rows) {
      const auto line = in_.next_line();
      if (!line) break;
      const std::string_view text = without_blanks(*line);
      if (text.empty() || is_comment(text) || begins_block(text)) continue;
      add_row(text, batch);
    }
    batch.bytes.resize(batch.count * layout_.stride);
    if (batch.count == 0 && block_rows_ && rows_ < *block_rows_)
      fail_number_of_rows("the file ends here with fewer");
    return batch.count > 0;
  }

 private:
  std::vector<std::string> find_names(const TextStart& start, const TextPlaces& places, const Fields& header,
                                      const Fields& cells, const ReadOptions& options) {
    const Fields given = split(options.columns, ' ');
    const bool is_mapping = options.columns.find('=') != std::string::npos;
    if (!given.empty() && !is_mapping) return column_names(given);
    std::vector<std::string> names = header.empty() ? commented_names(start, cells, is_mapping)
                                                    : column_names(header);
    if (is_mapping) {
      if (names.empty())
        in_.fail_at_line(in_.line(), "no header line; names of columns can be given only in their order");
      return mapped_names(std::move(names), given);
    }
    if (!names.empty()) return names;
    if (places.row > 0)
      in_.fail_at_line(start.lines[0].number,
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
  std::vector<std::string> commented_names(const TextStart& start, const Fields& cells, bool any) {
    for (auto comment = start.comments.rbegin(); comment != start.comments.rend(); ++comment) {
      const Fields fields = comment_fields(std::string_view(*comment).substr(0, comment->find('[')));
      const bool has_list = comment->find("[]") != comment->npos;
      const Fields whole = has_list ? fields : comment_fields(*comment);
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
      const auto place = [&](const char* name) {
        return static_cast<std::size_t>(std::find(found.begin(), found.end(), name) - found.begin());
      };
      const bool is_at_start = place("x") == 0 && place("y") == 1 && place("z") == 2;
      if (is_at_start || std::max({place("x"), place("y"), place("z")}) >= cells.size()) continue;
      in_.fail_at_line(in_.line(), "the row has " + std::to_string(cells.size()) +
                                       " values, and the comment before it names " +
                                       std::to_string(names.size()) + " columns: " + joined(names) +
                                       "; --columns says what the columns are, such as --columns id,x,y,z");
    }
    return {};
  }

  // Names from a header, some of them replaced: "x=Easting" makes the column Easting x.
  std::vector<std::string> mapped_names(std::vector<std::string> names, const Fields& given) {
    for (const std::string_view word : given) {
      const std::size_t equals = word.find('=');
      const std::string from(equals == word.npos ? std::string_view() : word.substr(equals + 1));
      const auto found = std::find(names.begin(), names.end(), from);
      if (from.empty() || found == names.end()) {
        in_.fail_at_line(in_.line(),
                         "no column for " + in_quotes(word) + "; the columns are " + joined(names));
      }
      *found = column_name(word.substr(0, equals), 0);
      is_geographic_ = is_geographic_ || (is_name_of_degrees(from) && (*found == "x" || *found == "y"));
    }
    return names;
  }

  // Makes the columns of the names, but those that have words, which are not read.
  void name_rows(std::vector<std::string>& names, const std::vector<Line>& lines) {
    if (!names.empty() && names.back() == kMore) {
      has_more_ = true;
      names.pop_back();
    }
    const std::vector<std::string> given = names;
    const PositionNames position = name_position(names);
    if (position == PositionNames::kNone && !has_position(names))
      in_.fail_at_line(in_.line(), "no columns named x, y and z, but " + joined(names) +
                                       "; --columns x=...,y=...,z=... says which they are");
    is_geographic_ = is_geographic_ || position == PositionNames::kDegrees;
    const SampledRows rows = sample(names, lines);
    if (is_unnamed_) {
      if (const std::string doubt = doubt_of_first_columns(rows); !doubt.empty())
        in_.fail_at_line(in_.line(), "no header line, and " + doubt + ", in " + in_quotes(lines[0].text) +
                                         " first; --columns says what the columns are, such as --columns "
                                         "id,x,y,z or --columns x,y,z,a");
    }
    const auto place = [&](const char* name) {
      return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    };
    is_geographic_ = is_geographic_ || look_like_degrees(rows, place("x"), place("y"), place("z"));
    set_columns(names);
  }

  // Reads the sampled lines that have a value for each column, and marks columns with words as not read.
  SampledRows sample(std::vector<std::string>& names, const std::vector<Line>& lines) const {
    SampledRows rows{.columns = names.size(), .values = {}};
    constexpr std::size_t kMostValues = std::size_t{1} << 16;
    for (const Line& line : lines) {
      if (rows.values.size() >= kMostValues) break;
      const Fields cells = split(line.text, separator_);
      if (cells.size() < names.size() || (cells.size() > names.size() && !has_more_)) continue;
      for (std::size_t i = 0; i < names.size(); ++i) {
        double value = std::numeric_limits<double>::quiet_NaN();
        if (!parse_number(cells[i], value) && !parse_foreign_number(cells[i], value) && !is_missing(cells[i]) &&
            names[i] != "x" && names[i] != "y" && names[i] != "z")
          names[i] = kNotRead;
        rows.values.push_back(value);
      }
    }
    return rows;
  }

  void set_columns(const std::vector<std::string>& names) {
    std::set<std::string> seen;
    std::vector<std::pair<std::string, Scalar>> columns;
    for (const std::string& name : names) {
      is_read_.push_back(name != kNotRead);
      if (name == kNotRead) continue;
      if (!seen.insert(name).second) {
        in_.fail_at_line(in_.line(), "a second column " + in_quotes(name) + "; names must differ");
      }
      columns.emplace_back(name, Scalar::kFloat64);
    }
    layout_ = packed_layout(columns);
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

  void add_row(std::string_view row, RowBatch& batch) {
    if (rows_ == block_rows_) fail_number_of_rows("more");
    parse_row(row, batch.bytes.data() + batch.count * layout_.stride);
    ++batch.count;
    ++rows_;
  }

  void parse_row(std::string_view rest, std::byte* to) const {
    const std::string_view row = rest;
    std::string_view field;
    for (std::size_t i = 0; i < is_read_.size(); ++i) {
      if (!next_cell(rest, separator_, field)) {
        // No field follows a last separator, but an empty cell does.
        if (i + 1 < is_read_.size() || i == 0 || separator_ == ' ' || without_end(row).back() != separator_)
          fail_number_of_values("fewer");
        field = {};
      }
      if (!is_read_[i]) continue;
      double value;
      if (!parse_number(field, value) && !parse_foreign_number(field, value)) {
        if (!is_missing(field)) fail_number(field);
        value = std::numeric_limits<double>::quiet_NaN();
      }
      std::memcpy(to, &value, sizeof(value));
      to += sizeof(value);
    }
    if (!has_more_ && next_cell(rest, separator_, field)) fail_number_of_values("more");
  }

  [[noreturn]] void fail_number(std::string_view field) const {
    in_.fail_at_line(in_.line(), in_quotes(field) +
                                     " is not a number; --columns leaves a column out that has the name _, "
                                     "such as --columns x,y,z,_");
  }

  [[noreturn]] void fail_number_of_values(const std::string& comparison) const {
    in_.fail_at_line(in_.line(), comparison + " values than the " +
                                     std::to_string(is_read_.size()) +
                                     " columns; every row must have one for each");
  }

  [[noreturn]] void fail_number_of_rows(const std::string& comparison) const {
    in_.fail_at_line(in_.line(), comparison + " rows than the " + std::to_string(*block_rows_) +
                                     " that a line before them declares");
  }

  InputFile in_;
  char separator_ = ' ';
  RowLayout layout_;
  std::vector<char> is_read_;  // of each column of the file
  bool has_more_ = false;      // rows may have more values than columns
  bool is_unnamed_ = false;    // the columns have names by their order alone
  bool is_geographic_ = false;
  std::optional<std::uint64_t> block_rows_;  // of the current block, where its rows are counted
  std::uint64_t rows_ = 0;                   // of it so far
  std::string pending_;                      // the first row, read to find the columns
};

}  // namespace

bool looks_like_text(const FileStart& start) {
  return start.first_bytes.find('\0') == std::string_view::npos;
}

std::unique_ptr<ScanReader> open_text(const std::filesystem::path& file, const ReadOptions& options) {
  return std::make_unique<TextReader>(file, options);
}

}  // namespace lacuna::io
