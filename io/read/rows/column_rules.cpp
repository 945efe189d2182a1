// SPDX-License-Identifier: Apache-2.0
#include "io/read/rows/column_rules.hpp"

#include "io/read/rows/scan_reader.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

namespace lacuna::io {
namespace {

constexpr std::size_t kFewestSampledRows = 10;

using Synonyms = std::span<const std::string_view>;

constexpr std::string_view kXNames[] = {"x",           "easting",    "east",        "e",        "xcoord",
                                        "xcoordinate", "xutm",       "utmx",        "pointx",   "posx",
                                        "positionx",   "cartesianx", "rechtswert",  "eastings", "coordx",
                                        "utmeasting",  "points0",    "pointsmxyz0", "rdx"};
constexpr std::string_view kYNames[] = {"y",           "northing",   "north",       "n",         "ycoord",
                                        "ycoordinate", "yutm",       "utmy",        "pointy",    "posy",
                                        "positiony",   "cartesiany", "hochwert",    "northings", "coordy",
                                        "utmnorthing", "points1",    "pointsmxyz1", "rdy"};
constexpr std::string_view kZNames[] = {"z",
                                        "height",
                                        "elevation",
                                        "elev",
                                        "alt",
                                        "altitude",
                                        "h",
                                        "zcoord",
                                        "zcoordinate",
                                        "pointz",
                                        "posz",
                                        "positionz",
                                        "cartesianz",
                                        "heights",
                                        "coordz",
                                        "ellipsoidalheight",
                                        "orthometricheight",
                                        "points2",
                                        "pointsmxyz2",
                                        "hoehe",
                                        "hhe",  // Höhe without its umlaut
                                        "nap"};
constexpr std::string_view kLongitudes[] = {"lon", "lng", "long", "longitude", "londeg"};
constexpr std::string_view kLatitudes[] = {"lat", "latitude", "latdeg"};
constexpr std::string_view kTimes[] = {"gpstime",    "gpstimes",   "time",     "times",   "timesec",
                                       "timestamp",  "stamp",      "unixtime", "utctime", "weeksec",
                                       "gpsweeksec", "sow",        "tow",      "gpssow",  "gpstow",
                                       "gpssec",     "gpsseconds", "seconds",  "sec",     "t"};
constexpr std::string_view kBeginnings[] = {"longitude", "latitude", "easting", "northing",
                                            "elevation", "altitude", "height"};

std::string lower_letters(std::string_view text) {
  std::string lower = lower_case(text);
  std::erase_if(lower, [](char c) { return !(c >= 'a' && c <= 'z') && !(c >= '0' && c <= '9'); });
  return lower;
}

// "Easting (m)", "easting_m" and "EASTING[ft]" are "easting", and "field.x" is "x".
std::string plain_name(std::string_view name) {
  if (const std::size_t dot = name.rfind('.'); dot != name.npos && dot + 2 == name.size()) {
    const std::string axis = lower_letters(name.substr(dot + 1));
    if (axis == "x" || axis == "y" || axis == "z") return axis;
  }
  if (const std::size_t bracket = name.find_first_of("([{"); bracket != name.npos && bracket > 0)
    name = name.substr(0, bracket);
  while (!name.empty() && (name.back() == '_' || name.back() == ' ')) name.remove_suffix(1);
  const std::size_t last = name.find_last_of("_ .-/");
  if (last != name.npos && last > 0) {
    const std::string unit = lower_letters(name.substr(last + 1));
    for (const char* known : {"m", "mm", "cm", "km", "ft", "usft", "deg", "degrees", "metre", "metres",
                              "meter", "meters", "feet"}) {
      if (unit == known) return lower_letters(name.substr(0, last));
    }
  }
  return lower_letters(name);
}

// Returns the one column with such a name; the first synonym, x itself, has priority. `count` is the number
// of columns that fit.
std::optional<std::size_t> find_axis(const std::vector<std::string>& names, Synonyms synonyms,
                                     std::size_t& count) {
  std::optional<std::size_t> found;
  count = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == synonyms.front()) {
      count = 1;
      return i;
    }
    if (std::find(synonyms.begin(), synonyms.end(), plain_name(names[i])) == synonyms.end()) continue;
    if (!found) found = i;
    ++count;
  }
  return found;
}

bool is_whole_column(const SampledRows& rows, std::size_t column) {
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const double value = rows.at(row, column);
    if (std::isfinite(value) && std::trunc(value) != value) return false;
  }
  return true;
}

bool counts_by_one(const SampledRows& rows) {
  for (std::size_t row = 1; row < rows.rows(); ++row) {
    if (rows.at(row, 0) != rows.at(0, 0) + static_cast<double>(row)) return false;
  }
  return true;
}

// Whether two columns are the same, and not of one value.
bool repeats(const SampledRows& rows, std::size_t a, std::size_t b) {
  bool is_constant = true;
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    if (rows.at(row, a) != rows.at(row, b)) return false;
    is_constant = is_constant && rows.at(row, a) == rows.at(0, a);
  }
  return !is_constant;
}

bool never_falls(const SampledRows& rows) {
  for (std::size_t row = 1; row < rows.rows(); ++row) {
    if (!(rows.at(row, 0) >= rows.at(row - 1, 0))) return false;
  }
  return true;
}

// Whether a grid is written by x, the first column: y goes one way while x stays, and back where x changes.
bool is_grid_by_first(const SampledRows& rows) {
  double way = 0;
  for (std::size_t row = 1; row < rows.rows(); ++row) {
    const double step = rows.at(row, 1) - rows.at(row - 1, 1);
    const double along = rows.at(row, 0) == rows.at(row - 1, 0) ? step : -step;
    if (way == 0) way = along;
    if (!(along * way > 0)) return false;
  }
  return way != 0 && rows.at(0, 0) != rows.at(rows.rows() - 1, 0);
}

bool is_share(const SampledRows& rows, std::size_t column) {
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    if (!(rows.at(row, column) >= 0 && rows.at(row, column) <= 1)) return false;
  }
  return true;
}

// Whether the first columns, one or three, are from 0 to 1, as intensities and colours are, and none of the
// three behind them is. One of these goes beyond 10: normals and features behind points of a unit cube do
// not.
bool begins_with_shares(const SampledRows& rows, std::size_t count) {
  constexpr double kFar = 10;
  for (std::size_t column = 0; column < count + 3; ++column) {
    if (column >= rows.columns || is_share(rows, column) != (column < count)) return false;
  }
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    for (std::size_t column = count; column < count + 3; ++column)
      if (std::abs(rows.at(row, column)) > kFar) return true;
  }
  return false;
}

}  // namespace

bool is_name_of_degrees(std::string_view name) {
  const std::string plain = plain_name(name);
  for (const Synonyms names : {Synonyms(kLongitudes), Synonyms(kLatitudes)}) {
    if (std::find(names.begin(), names.end(), plain) != names.end()) return true;
  }
  return plain.starts_with("longitude") || plain.starts_with("latitude");
}

std::optional<std::size_t> find_time(std::span<const std::string> names) {
  for (const std::string_view known : kTimes) {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (plain_name(names[i]) == known) return i;
  }
  return std::nullopt;
}

PositionNames name_position(std::vector<std::string>& names) {
  std::size_t x_count = 0, y_count = 0, z_count = 0;
  const auto z = find_axis(names, kZNames, z_count);
  if (z_count != 1) return PositionNames::kNone;
  for (const auto& [x_names, y_names, kind] :
       {std::tuple(Synonyms(kXNames), Synonyms(kYNames), PositionNames::kLengths),
        std::tuple(Synonyms(kLongitudes), Synonyms(kLatitudes), PositionNames::kDegrees)}) {
    const auto x = find_axis(names, x_names, x_count);
    const auto y = find_axis(names, y_names, y_count);
    if (x_count > 1 || y_count > 1) return PositionNames::kNone;
    if (!x || !y) continue;
    names[*x] = "x";
    names[*y] = "y";
    names[*z] = "z";
    return kind;
  }
  return PositionNames::kNone;
}

bool name_some_position(std::span<const std::string> names) {
  std::size_t count = 0;
  for (const std::string& name : names) {
    const std::string plain = lower_letters(name);
    count += std::any_of(std::begin(kBeginnings), std::end(kBeginnings),
                         [&](std::string_view begin) { return plain.starts_with(begin); });
  }
  return count >= 2;
}

std::string doubt_of_first_columns(const SampledRows& rows) {
  if (rows.rows() < kFewestSampledRows || rows.columns < 3) return {};
  for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 2)}) {
    if (repeats(rows, a, b))
      return "column " + std::to_string(b + 1) + " repeats column " + std::to_string(a + 1);
  }
  if (rows.columns < 4) return {};
  std::size_t whole = 0;
  while (whole + 3 < rows.columns && is_whole_column(rows, whole)) ++whole;
  const bool is_from_start = rows.at(0, 0) == 0 || rows.at(0, 0) == 1;
  const auto is_whole = [&](std::size_t column) {
    const double value = rows.at(0, column);
    return std::trunc(value) == value;
  };
  if (counts_by_one(rows) && whole > 0 && (is_from_start || (!is_whole(1) && !is_whole(2) && !is_whole(3))))
    return "the first column counts the rows";
  const auto has_decimals = [&](std::size_t first) {
    return first + 3 <= rows.columns && !is_whole_column(rows, first) && !is_whole_column(rows, first + 1) &&
           !is_whole_column(rows, first + 2);
  };
  if (whole > 0 && has_decimals(whole))
    return whole == 1 ? "the first column has whole numbers alone, and three with decimals follow"
                      : "the first " + std::to_string(whole) +
                            " columns have whole numbers alone, and three with decimals follow";
  if (whole == 0 && never_falls(rows) && has_decimals(1) && !is_grid_by_first(rows))
    return "the first column never falls from row to row, as times do";
  for (const std::size_t count : {1, 3}) {
    if (begins_with_shares(rows, count) && has_decimals(count))
      return count == 1
                 ? "the first column is from 0 to 1, as intensities are, and the next three are not"
                 : "the first three columns are from 0 to 1, as colours are, and the next three are not";
  }
  return {};
}

}  // namespace lacuna::io
