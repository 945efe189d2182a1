// SPDX-License-Identifier: Apache-2.0
#include "io/text/text_reader.hpp"

#include "io/files/input_file.hpp"
#include "io/files/number.hpp"
#include "io/files/property_name.hpp"
#include "io/rows/scalar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

namespace lacuna::io {
namespace {

constexpr const char* kAllowed = "rows of numbers divided by blanks, commas or semicolons are allowed";

using Fields = std::vector<std::string_view>;

Fields split(std::string_view line, char separator);

// Commas divide values, unless a blank is left within a value. Then the commas are decimal commas.
char find_separator(std::string_view line) {
  if (line.find(';') != std::string_view::npos) return ';';
  if (line.find(',') == std::string_view::npos) return ' ';
  const Fields fields = split(line, ',');
  const bool is_decimal = std::any_of(fields.begin(), fields.end(), [](std::string_view field) {
    double value;
    const Fields words = split(field, ' ');
    return words.size() > 1 && parse_number(words[0], value);
  });
  return is_decimal ? ' ' : ',';
}

Fields split(std::string_view line, char separator) {
  Fields fields;
  for (std::string_view field; next_field(line, separator, field);) fields.push_back(field);
  return fields;
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
  double value;
  return parse_number(field, value) || field.find_first_of("0123456789+-.") == 0;
}

std::string column_name(std::string_view field, std::size_t index) {
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"') {
    field = field.substr(1, field.size() - 2);
  }
  if (field.empty()) return "column_" + std::to_string(index + 1);
  return property_name(field);
}

std::vector<std::string> column_names(const Fields& fields) {
  std::vector<std::string> names;
  for (const std::string_view field : fields) names.push_back(column_name(field, names.size()));
  return names;
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

// Whether the first values of all sampled rows count up by one, as ids do. They count from 0 or 1 on, or from
// any number where the three values behind it are no whole numbers. `first` has four fields at least;
// `others` are the lines behind it, the last one perhaps cut.
bool counts_rows(const Fields& first, std::string_view others, char separator) {
  constexpr std::size_t kFewRows = 10;
  std::array<double, 4> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!parse_number(first[i], values[i]) && !parse_foreign_number(first[i], values[i])) return false;
  }
  const auto is_whole = [](double value) { return std::trunc(value) == value; };
  const bool is_from_start = values[0] == 0 || values[0] == 1;
  if (!is_whole(values[0]) || (!is_from_start && std::any_of(values.begin() + 1, values.end(), is_whole)))
    return false;
  std::size_t rows = 1;
  for (std::size_t end = others.find('\n'); end != others.npos; end = others.find('\n')) {
    const std::string_view line = without_blanks(others.substr(0, end));
    others.remove_prefix(end + 1);
    if (line.empty() || is_comment(line)) continue;
    std::string_view rest = line, field;
    double value = 0;
    if (!next_field(rest, separator, field) || !parse_number(field, value)) return false;
    if (value != values[0] + static_cast<double>(rows)) return false;
    ++rows;
  }
  return rows >= kFewRows;
}

// The lines before the rows.
struct Preamble {
  std::string comment;                 // the last, without its sign
  std::optional<std::uint64_t> count;  // on a line of its own
  std::string first;                   // the first line that is neither; empty without such a line
};

// A file whose lines end with a carriage return alone is one line for this reader.
void refuse_lone_returns(const InputFile& in, std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.find('\r') != std::string_view::npos)
    in.fail_at_line(in.line(), "a carriage return within the line; lines must end with LF or with CR and LF");
}

Preamble read_preamble(InputFile& in) {
  Preamble preamble;
  if (in.peek(3) == "\xef\xbb\xbf") in.skip(3);  // byte order mark of UTF-8
  while (const auto line = in.next_line()) {
    refuse_lone_returns(in, *line);
    const std::string_view text = without_blanks(*line);
    std::uint64_t count = 0;
    const Fields words = split(text, ' ');
    if (words.empty()) continue;
    if (is_comment(text)) {
      preamble.comment = text.substr(std::min(text.find_first_not_of("#/"), text.size()));
    } else if (!preamble.count && words.size() == 1 && parse_number(words[0], count)) {
      preamble.count = count;
    } else {
      preamble.first = text;
      break;
    }
  }
  return preamble;
}

class TextReader final : public ScanReader {
 public:
  TextReader(const std::filesystem::path& file, const ReadOptions& options) : in_(file) {
    const Preamble preamble = read_preamble(in_);
    separator_ = find_separator(preamble.first);
    const Fields first = split(preamble.first, separator_);
    if (first.size() > kMostColumns) in_.fail_at_line(in_.line(), kTooManyColumns);
    const bool has_header = !first.empty() && std::none_of(first.begin(), first.end(), is_numeric);
    if (first.empty() && preamble.count != std::uint64_t{0}) {
      in_.fail_at_line(in_.line(), std::string("the file ends here without a row; ") + kAllowed);
    }
    set_columns(find_names(preamble, first, has_header, options));
    if (!has_header) pending_ = preamble.first;
    block_rows_ = preamble.count;
  }

  std::string format() const override { return "text"; }
  const RowLayout& layout() const override { return layout_; }

  // A file of counted rows may have more such blocks behind the first.
  std::optional<std::uint64_t> expected_rows() const override { return std::nullopt; }

  bool next(RowBatch& batch, std::size_t max_rows) override {
    return fill_batch(batch, max_rows, layout_.stride, [&](std::byte* to) {
      if (!pending_.empty()) {
        put_row(std::exchange(pending_, {}), to);
        return true;
      }
      while (const auto line = in_.next_line()) {
        const std::string_view text = without_blanks(*line);
        if (text.empty() || is_comment(text) || begins_block(text)) continue;
        put_row(text, to);
        return true;
      }
      if (block_rows_ && rows_ < *block_rows_) fail_number_of_rows("the file ends here with fewer");
      return false;
    });
  }

 private:
  std::vector<std::string> find_names(const Preamble& preamble, const Fields& first, bool has_header,
                                      const ReadOptions& options) {
    const Fields given = split(options.columns, ' ');
    const bool is_mapping = options.columns.find('=') != std::string::npos;
    if (!given.empty() && !is_mapping) return column_names(given);
    if (has_header) return is_mapping ? mapped_names(column_names(first), given) : column_names(first);
    if (is_mapping)
      in_.fail_at_line(in_.line(), "no header line; names of columns can be given only in their order");
    const Fields comment = split(preamble.comment, find_separator(preamble.comment));
    if (comment.size() == first.size()) {
      const std::vector<std::string> in_comment = column_names(comment);
      if (has_position(in_comment)) return in_comment;
    }
    if (!first.empty() && first.size() < 3) {
      in_.fail_at_line(in_.line(), std::to_string(first.size()) + " values; at least x y z are needed");
    }
    if (preamble.count && !pts_names(first.size()).empty()) return pts_names(first.size());
    if (first.size() >= 4 && counts_rows(first, in_.peek(kSampleBytes), separator_)) {
      in_.fail_at_line(in_.line(), "no header line, and the first column counts the rows, in " +
                                       in_quotes(preamble.first) +
                                       " first; --columns says what the columns are, such as --columns "
                                       "id,x,y,z or --columns x,y,z,a");
    }
    return default_names(first.size());
  }

  // Names from a header, some of them replaced: "x=Easting" makes the column Easting x.
  std::vector<std::string> mapped_names(std::vector<std::string> names, const Fields& given) const {
    for (const std::string_view word : given) {
      const std::size_t equals = word.find('=');
      const std::string from(equals == word.npos ? std::string_view() : word.substr(equals + 1));
      const auto found = std::find(names.begin(), names.end(), from);
      if (from.empty() || found == names.end()) {
        in_.fail_at_line(in_.line(),
                         "no column for " + in_quotes(word) + "; the columns are " + joined(names));
      }
      *found = column_name(word.substr(0, equals), 0);
    }
    return names;
  }

  void set_columns(const std::vector<std::string>& names) {
    std::set<std::string> seen;
    std::vector<std::pair<std::string, Scalar>> columns;
    for (const std::string& name : names) {
      if (!seen.insert(name).second) {
        in_.fail_at_line(in_.line(), "a second column " + in_quotes(name) + "; names must differ");
      }
      columns.emplace_back(name, Scalar::kFloat64);
    }
    if (!has_position(names)) {
      in_.fail_at_line(in_.line(), "no columns named x, y and z, but " + joined(names) +
                                       "; --columns x=...,y=...,z=... says which they are");
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

  // A header line may be divided by something else than the rows.
  void find_row_separator(std::string_view row) {
    const std::size_t columns = layout_.properties.size();
    const char found = find_separator(row);
    if (split(row, separator_).size() != columns && split(row, found).size() == columns) separator_ = found;
    is_separator_of_rows_ = true;
  }

  void put_row(std::string_view row, std::byte* to) {
    if (!is_separator_of_rows_) find_row_separator(row);
    if (rows_ == block_rows_) fail_number_of_rows("more");
    parse_row(row, to);
    ++rows_;
  }

  void parse_row(std::string_view rest, std::byte* to) const {
    std::string_view field;
    for (const Property& property : layout_.properties) {
      if (!next_field(rest, separator_, field)) fail_number_of_values("fewer");
      double value;
      if (!parse_number(field, value) && !parse_foreign_number(field, value))
        in_.fail_at_line(in_.line(), in_quotes(field) + " is not a number");
      std::memcpy(to + property.offset, &value, sizeof(value));
    }
    if (next_field(rest, separator_, field)) fail_number_of_values("more");
  }

  [[noreturn]] void fail_number_of_values(const std::string& comparison) const {
    in_.fail_at_line(in_.line(), comparison + " values than the " +
                                     std::to_string(layout_.properties.size()) +
                                     " columns; every row must have one for each");
  }

  [[noreturn]] void fail_number_of_rows(const std::string& comparison) const {
    in_.fail_at_line(in_.line(), comparison + " rows than the " + std::to_string(*block_rows_) +
                                     " that a line before them declares");
  }

  InputFile in_;
  char separator_ = ' ';
  bool is_separator_of_rows_ = false;
  RowLayout layout_;
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
