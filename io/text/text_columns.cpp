// SPDX-License-Identifier: Apache-2.0
#include "io/text/text_columns.hpp"

#include "io/files/number.hpp"
#include "io/files/property_name.hpp"
#include "io/rows/scan_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace lacuna::io {
namespace {

constexpr const char* kAllowed = "rows of numbers divided by blanks, commas or semicolons are allowed";
constexpr const char* kSaysWhich = "--columns says what the columns are, such as --columns ";
constexpr std::size_t kSampleBytes = std::size_t{1} << 20;

struct Line {
  std::uint64_t number;
  std::string_view text;  // without blanks at its beginning, or the sign of a comment
};

// The lines before the first row.
struct Preamble {
  std::vector<Line> comments, others;
  std::optional<std::uint64_t> count;  // on a line of its own
  Line row{0, {}};                     // the first one; empty without rows
  std::string_view rest;               // behind it
};

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

bool is_number(std::string_view field) {
  double value;
  return parse_value(unquoted(field), value);
}

bool is_row(std::string_view line) {
  const Fields fields = split(line, find_separator(line));
  return std::count_if(fields.begin(), fields.end(), is_number) >= 3;
}

// Takes the next line off a text. A last line without an end is one, too.
std::optional<std::string_view> take_line(std::string_view& text) {
  if (text.empty()) return std::nullopt;
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

// A file whose lines end with a carriage return alone is one line for this reader.
void refuse_lone_returns(const InputFile& in, std::uint64_t number, std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.find('\r') != std::string_view::npos)
    in.fail_at_line(number, "a carriage return within the line; lines must end with LF or with CR and LF");
}

Preamble find_preamble(const InputFile& in, std::string_view sample) {
  Preamble preamble;
  std::uint64_t number = 0;
  while (const auto line = take_line(sample)) {
    refuse_lone_returns(in, ++number, *line);
    const std::string_view text = without_blanks(*line);
    std::uint64_t count = 0;
    if (text.empty()) continue;
    const Fields words = split(text, ' ');
    if (is_comment(text)) {
      preamble.comments.push_back({number, text.substr(std::min(text.find_first_not_of("#/"), text.size()))});
    } else if (is_row(text)) {
      preamble.row = {number, text};
      preamble.rest = sample;
      break;
    } else if (!preamble.count && preamble.others.empty() && words.size() == 1 &&
               parse_number(words[0], count)) {
      preamble.count = count;
    } else {
      preamble.others.push_back({number, text});
    }
  }
  return preamble;
}

std::string column_name(std::string_view field, std::size_t index) {
  field = unquoted(field);
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

std::size_t index_of(const std::vector<std::string>& names, std::string_view name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

bool has_position(const std::vector<std::string>& names) {
  return index_of(names, "x") < names.size() && index_of(names, "y") < names.size() &&
         index_of(names, "z") < names.size();
}

// ---- Names of the field

constexpr std::array<std::string_view, 13> kNamesOfX = {
    "x",      "easting",     "east",   "e",         "ost",    "rechts",    "rechtswert",
    "xcoord", "xcoordinate", "coordx", "positionx", "pointx", "utmeasting"};
constexpr std::array<std::string_view, 13> kNamesOfY = {
    "y",      "northing",    "north",  "n",         "nord",   "hoch",       "hochwert",
    "ycoord", "ycoordinate", "coordy", "positiony", "pointy", "utmnorthing"};
constexpr std::array<std::string_view, 13> kNamesOfZ = {
    "z",     "height", "elevation",   "elev",   "altitude",  "alt",   "h",
    "hoehe", "zcoord", "zcoordinate", "coordz", "positionz", "pointz"};
constexpr std::array<std::string_view, 8> kUnits = {"",      "m",      "metre", "metres",
                                                    "meter", "meters", "ft",    "feet"};

template <std::size_t kNames>
bool is_one_of(std::string_view name, const std::array<std::string_view, kNames>& names) {
  for (const std::string_view unit : kUnits) {
    if (!name.ends_with(unit)) continue;
    const std::string_view stem = name.substr(0, name.size() - unit.size());
    if (std::find(names.begin(), names.end(), stem) != names.end()) return true;
  }
  return false;
}

// Gives the name of an axis to the column that `is_it` holds for, unless a column has that name. Where `one`
// is set, several such columns leave the names as they are.
template <class IsIt>
bool name_axis(std::vector<std::string>& names, const char* axis, bool one, const IsIt& is_it) {
  if (index_of(names, axis) < names.size()) return true;
  const auto matches = [&](const std::string& name) { return is_it(bare_name(name)); };
  const auto found = std::find_if(names.begin(), names.end(), matches);
  if (found == names.end() || (one && std::count_if(names.begin(), names.end(), matches) > 1)) return false;
  *found = axis;
  return true;
}

// Names the columns x, y and z that have such names of the field. Returns whether they are longitude and
// latitude.
bool name_axes(std::vector<std::string>& names) {
  if (has_position(names)) return false;
  const bool has_x = name_axis(names, "x", true, [](std::string_view n) { return is_one_of(n, kNamesOfX); });
  const bool has_y = name_axis(names, "y", true, [](std::string_view n) { return is_one_of(n, kNamesOfY); });
  const bool has_z = name_axis(names, "z", true, [](std::string_view n) { return is_one_of(n, kNamesOfZ); });
  if (has_x || has_y) return false;
  const bool has_longitude = name_axis(names, "x", false, [](std::string_view n) {
    return n.starts_with("longitude") || n == "lon" || n == "long" || n == "lng";
  });
  const bool has_latitude = name_axis(
      names, "y", false, [](std::string_view n) { return n.starts_with("latitude") || n == "lat"; });
  if (!has_z) {
    name_axis(names, "z", false, [](std::string_view n) {
      return n.starts_with("elevation") || n.starts_with("height") || n.starts_with("altitude");
    });
  }
  return has_longitude && has_latitude;
}

// ---- What unnamed columns hold

// The first rows as numbers; a row that has others than the first one ends them.
struct Sample {
  std::vector<std::vector<double>> columns;

  std::size_t rows() const { return columns.empty() ? 0 : columns[0].size(); }
  bool is_whole(std::size_t c) const {
    return std::all_of(columns[c].begin(), columns[c].end(), [](double v) { return std::trunc(v) == v; });
  }
  bool is_mostly_broken(std::size_t c) const {
    const auto whole =
        std::count_if(columns[c].begin(), columns[c].end(), [](double v) { return std::trunc(v) == v; });
    return static_cast<std::size_t>(whole) < rows() / 2;
  }
  bool counts(std::size_t c) const {
    for (std::size_t i = 1; i < rows(); ++i) {
      if (columns[c][i] != columns[c][0] + static_cast<double>(i)) return false;
    }
    return true;
  }
  double least(std::size_t c) const { return *std::min_element(columns[c].begin(), columns[c].end()); }
  double most(std::size_t c) const { return *std::max_element(columns[c].begin(), columns[c].end()); }
};

// Takes the columns at these places of the first rows.
Sample sample_of(const Preamble& preamble, char separator, std::span<const std::size_t> places) {
  constexpr std::size_t kMostRows = 5000;
  Sample sample;
  sample.columns.resize(places.size());
  std::string_view rest = preamble.rest, line = preamble.row.text;
  std::vector<double> row(places.size());
  while (sample.rows() < kMostRows) {
    if (!line.empty() && !is_comment(line)) {
      const Fields fields = split(line, separator);
      for (std::size_t i = 0; i < places.size(); ++i) {
        if (places[i] >= fields.size() || !parse_value(unquoted(fields[places[i]]), row[i])) return sample;
      }
      for (std::size_t i = 0; i < places.size(); ++i) sample.columns[i].push_back(row[i]);
    }
    const auto next = take_line(rest);
    if (!next) return sample;
    line = without_blanks(*next);
  }
  return sample;
}

constexpr std::size_t kFewRows = 10;

// Returns what the unnamed columns of a file seem to be, other than x, y and z, and an example of their
// names.
std::string doubt_about(const Sample& sample) {
  const std::size_t columns = sample.columns.size();
  if (sample.rows() < kFewRows) return "";
  const auto are_broken = [&](std::size_t first) {
    return sample.is_mostly_broken(first) && sample.is_mostly_broken(first + 1) &&
           sample.is_mostly_broken(first + 2);
  };
  const bool is_whole = columns >= 4 && sample.is_whole(0);
  const bool is_from_start = sample.columns[0][0] == 0 || sample.columns[0][0] == 1;
  const std::string id = std::string("; ") + kSaysWhich + "id,x,y,z or --columns x,y,z,a";
  if (is_whole && sample.counts(0) && (is_from_start || are_broken(1)))
    return "the first column counts the rows" + id;
  if (is_whole && are_broken(1))
    return "the first column has whole numbers alone, before three that do not" + id;
  if (columns >= 5 && is_whole && sample.is_whole(1) && are_broken(2))
    return std::string("the first two columns have whole numbers alone, before three that do not; ") +
           kSaysWhich + "row,column,x,y,z";
  for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 2)}) {
    if (sample.columns[a] == sample.columns[b] && sample.least(a) != sample.most(a))
      return "column " + std::to_string(b + 1) + " repeats column " + std::to_string(a + 1) + "; " +
             kSaysWhich + "a,x,y,z";
  }
  return "";
}

// Whether x and y are degrees, since a scan in lengths would be a needle, or float far above its origin.
bool look_like_degrees(const Sample& xyz) {
  constexpr double kNeedle = 300, kFarAbove = 90;
  if (xyz.rows() < kFewRows) return false;
  const double extent = std::max(xyz.most(0) - xyz.least(0), xyz.most(1) - xyz.least(1));
  const bool are_within =
      std::max(-xyz.least(0), xyz.most(0)) <= 180 && std::max(-xyz.least(1), xyz.most(1)) <= 90;
  return are_within && extent > 0 && extent < 1 && xyz.is_mostly_broken(0) && xyz.is_mostly_broken(1) &&
         (xyz.most(2) - xyz.least(2) > kNeedle * extent || xyz.least(2) > kFarAbove);
}

// ---- Names of columns

class ColumnFinder {
 public:
  ColumnFinder(const InputFile& in, const Preamble& preamble, std::string_view given)
      : in_(in), preamble_(preamble), given_(given) {
    columns_.separator = find_separator(preamble.row.text);
    row_ = split(preamble.row.text, columns_.separator);
    line_ = preamble.row.number;
    if (row_.size() > kMostColumns) in_.fail_at_line(line_, kTooManyColumns);
  }

  TextColumns find() {
    columns_.block_rows = preamble_.count;
    columns_.lines_before =
        preamble_.row.text.empty() ? std::numeric_limits<std::uint64_t>::max() : preamble_.row.number - 1;
    const Fields given = split(given_, ' ');
    const bool is_mapping = given_.find('=') != given_.npos;
    if (!given.empty() && !is_mapping) {
      columns_.names = column_names(given);
    } else if (const Line* const header = find_header(is_mapping)) {
      line_ = header->number;
      columns_.names = names_of(*header);
      if (is_mapping) {
        map_names(given);
      } else {
        columns_.are_degrees = name_axes(columns_.names);
      }
    } else if (is_mapping) {
      in_.fail_at_line(line_, "no header line; names of columns can be given only in their order");
    } else {
      columns_.names = names_without_header();
    }
    check_names();
    if (!columns_.are_degrees) columns_.are_degrees = look_like_degrees(positions());
    return columns_;
  }

 private:
  // Names up to the first list: "TRACK[]" stands for any number of values.
  std::vector<std::string> names_of(const Line& header) {
    std::vector<std::string> names = column_names(split(header.text, find_separator(header.text)));
    const auto list = std::find_if(names.begin(), names.end(),
                                   [](const std::string& name) { return name.find("[]") != name.npos; });
    columns_.has_list = list != names.end();
    names.erase(list, names.end());
    return names;
  }

  bool fits(const std::vector<std::string>& names) const {
    return columns_.has_list ? names.size() <= row_.size() : names.size() == row_.size();
  }

  // Returns the line just before the rows, if it names columns, else a comment that does. A comment names as
  // many columns as the first row has, and a position, unless other names are given.
  const Line* find_header(bool is_mapping) {
    if (!preamble_.others.empty()) {
      const Line& last = preamble_.others.back();
      std::vector<std::string> names = names_of(last);
      if (preamble_.row.text.empty() || fits(names)) return &last;
      name_axes(names);
      if (has_position(names)) return &last;
    }
    for (auto comment = preamble_.comments.rbegin(); comment != preamble_.comments.rend(); ++comment) {
      std::vector<std::string> names = names_of(*comment);
      if (!fits(names)) continue;
      name_axes(names);
      if (is_mapping || has_position(names)) return &*comment;
    }
    columns_.has_list = false;
    return nullptr;
  }

  // Some names of the header are replaced: "x=Easting" makes the column Easting x.
  void map_names(const Fields& given) {
    std::vector<std::string>& names = columns_.names;
    for (const std::string_view word : given) {
      const std::size_t equals = word.find('=');
      const std::string from(equals == word.npos ? std::string_view() : word.substr(equals + 1));
      const auto found = std::find(names.begin(), names.end(), from);
      if (from.empty() || found == names.end())
        in_.fail_at_line(line_, "no column for " + in_quotes(word) + "; the columns are " + joined(names));
      *found = column_name(word.substr(0, equals), 0);
    }
  }

  std::vector<std::string> names_without_header() {
    if (preamble_.count && !pts_names(row_.size()).empty()) return pts_names(row_.size());
    if (!std::all_of(row_.begin(), row_.begin() + 3, is_number))
      in_.fail_at_line(line_, "no header line, and the first three columns of " +
                                  in_quotes(preamble_.row.text) + " are not numbers; " + kSaysWhich +
                                  "id,x,y,z");
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < std::min<std::size_t>(row_.size(), 5); ++i) {
      if (is_number(row_[i])) places.push_back(i);
    }
    if (const std::string doubt = doubt_about(sample_of(preamble_, columns_.separator, places));
        !doubt.empty())
      in_.fail_at_line(line_, "no header line, and in " + in_quotes(preamble_.row.text) + " " + doubt);
    return default_names(row_.size());
  }

  void check_names() {
    std::set<std::string> seen;
    for (const std::string& name : columns_.names) {
      if (!seen.insert(name).second)
        in_.fail_at_line(line_, "a second column " + in_quotes(name) + "; names must differ");
    }
    if (!has_position(columns_.names))
      in_.fail_at_line(line_, "no columns named x, y and z, but " + joined(columns_.names) +
                                  "; --columns x=...,y=...,z=... says which they are");
  }

  Sample positions() const {
    if (preamble_.row.text.empty()) return {};
    std::array<std::size_t, 3> places{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      places[axis] = index_of(columns_.names, std::string_view("xyz").substr(axis, 1));
    return sample_of(preamble_, columns_.separator, places);
  }

  const InputFile& in_;
  const Preamble& preamble_;
  std::string_view given_;
  TextColumns columns_;
  Fields row_;          // the first one
  std::uint64_t line_;  // that errors name
};

// Says why there is no row, where there are lines that are no header.
void require_row(const InputFile& in, const Preamble& preamble) {
  if (!preamble.row.text.empty()) return;
  if (preamble.others.empty()) {
    if (preamble.count == std::uint64_t{0}) return;
    in.fail_at_line(preamble.comments.empty() ? 1 : preamble.comments.back().number,
                    std::string("the file has no row; ") + kAllowed);
  }
  const Line& last = preamble.others.back();
  const Fields fields = split(last.text, find_separator(last.text));
  if (std::none_of(fields.begin(), fields.end(), is_number)) return;  // a header alone
  if (fields.size() < 3)
    in.fail_at_line(last.number, std::to_string(fields.size()) + " values; at least x y z are needed");
  const auto wrong = std::find_if_not(fields.begin(), fields.end(), is_number);
  in.fail_at_line(last.number, in_quotes(*wrong) + " is not a number");
}

}  // namespace

Fields split(std::string_view line, char separator) {
  Fields fields;
  for (std::string_view field; next_field(line, separator, field);) fields.push_back(field);
  return fields;
}

std::string_view unquoted(std::string_view field) {
  const bool is_quoted = field.size() >= 2 && field.front() == '"' && field.back() == '"';
  return is_quoted ? field.substr(1, field.size() - 2) : field;
}

std::string_view without_blanks(std::string_view line) {
  return line.substr(std::min(line.find_first_not_of(" \t\r\v\f"), line.size()));
}

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with("//");
}

bool parse_value(std::string_view field, double& value) {
  return parse_number(field, value) || parse_foreign_number(field, value);
}

TextColumns find_text_columns(InputFile& in, std::string_view given) {
  if (in.peek(3) == "\xef\xbb\xbf") in.skip(3);  // byte order mark of UTF-8
  std::string_view sample = in.peek(kSampleBytes);
  if (sample.size() == kSampleBytes)
    sample = sample.substr(0, sample.rfind('\n') + 1);  // without half a line
  const Preamble preamble = find_preamble(in, sample);
  require_row(in, preamble);
  if (preamble.row.text.empty() && preamble.others.empty())
    return {.names = {"x", "y", "z"}, .lines_before = 0, .block_rows = preamble.count};
  return ColumnFinder(in, preamble, given).find();
}

}  // namespace lacuna::io
