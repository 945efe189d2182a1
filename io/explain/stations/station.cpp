// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/station.hpp"

#include "io/explain/stations/station_views.hpp"
#include "io/read/files/number.hpp"
#include "io/read/rows/column_rules.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/text/text_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <spdlog/fmt/fmt.h>

namespace lacuna::io {
namespace {

// Commas divide fields, unless they are decimal commas, as in scans of text.
void split_fields(std::string_view line, std::vector<std::string_view>& fields) {
  constexpr std::string_view kWithoutCommas = " \t\r;";
  const std::string_view divisors = find_separator(line) == ',' ? kFieldDivisors : kWithoutCommas;
  fields.clear();
  for (std::size_t begin; (begin = line.find_first_not_of(divisors)) != line.npos;) {
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(divisors), line.size());
    fields.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

bool is_header(Fields fields) {
  double number = 0;
  return std::none_of(fields.begin(), fields.end(),
                      [&](std::string_view field) { return parse_cell(field, number); });
}

}  // namespace

std::string read_number(std::string_view field, double most, double& number) {
  if (!parse_cell(field, number) || !std::isfinite(number)) return in_quotes(field) + " is not a number";
  if (std::fabs(number) <= most) return "";
  return fmt::format("{} is not from -{:g} to {:g}", in_quotes(field), most, most);
}

std::optional<Fields> ListLines::next() {
  while (const auto line = in_.next_line()) {
    split_fields(*line, fields_);
    if (fields_.empty() || fields_[0].starts_with('#')) continue;
    const bool is_skipped = std::exchange(is_first_, false) && is_header(fields_);
    if (!is_skipped) return fields_;
  }
  return std::nullopt;
}

Eigen::Vector3d ListLines::parse_place(Fields xyz) const {
  Eigen::Vector3d place;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const std::string wrong = read_number(xyz[static_cast<std::size_t>(axis)], kFarthest, place[axis]);
    if (!wrong.empty()) fail(wrong);
  }
  return place;
}

void ListLines::fail(std::string reason) const {
  if (!reason.empty()) reason += "; ";
  in_.fail_at_line(in_.line(), reason + std::string(needed_));
}

void ListLines::fail_empty(const std::string& reason) const {
  in_.fail(reason + "; on each line, " + std::string(needed_));
}

std::vector<ListedPosition> read_places(const std::filesystem::path& list) {
  ListLines lines(list, "x y z are needed, or a name and x y z");
  std::vector<ListedPosition> places;
  while (const auto fields = lines.next()) {
    if (fields->size() != 3 && fields->size() != 4) lines.fail();
    places.push_back({.name = fields->size() == 4 ? std::string(fields->front()) : "",
                      .position = lines.parse_place(fields->last(3))});
  }
  if (places.empty()) lines.fail_empty("names no place");
  return places;
}

namespace {

namespace fs = std::filesystem;

// Whether `name` is the whole name of `file`, or its last parts.
bool names(const fs::path& name, const fs::path& file) {
  auto part = name.end();
  auto of_file = file.end();
  while (part != name.begin()) {
    if (of_file == file.begin() || *--part != *--of_file) return false;
  }
  return !name.empty();
}

std::size_t file_named(const fs::path& name, std::span<const fs::path> files, const InputFile& in) {
  if (std::ranges::count(files, name) == 1)
    return static_cast<std::size_t>(std::ranges::find(files, name) - files.begin());
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!names(name, files[i])) continue;
    if (found)
      in.fail_at_line(in.line(), name.string() + " is the name of several scans; more of its path is needed");
    found = i;
  }
  if (!found) in.fail_at_line(in.line(), name.string() + " is not the name of a scan of this run");
  return *found;
}

const Property* source_column(const RowLayout& layout) {
  const Property* const scan = layout.find("scan");
  return scan != nullptr ? scan : layout.find("point_source_id");
}

// `number`: of the station in the list, the name of one without.
Station parse_station(Fields fields, std::size_t number, std::span<const fs::path> files,
                      const ListLines& lines) {
  if (fields.size() == 3) return {.name = std::to_string(number), .place = lines.parse_place(fields)};
  if (fields.size() < 4 || fields.size() > 6) lines.fail();
  Station station{.name = std::string(fields[0]), .place = lines.parse_place(fields.subspan(1, 3))};
  fields = fields.subspan(4);
  if (fields.empty()) return station;
  if (std::uint32_t source = 0; parse_number(fields.back(), source)) {
    station.source = source;
    fields = fields.first(fields.size() - 1);
  }
  if (fields.size() > 1) lines.fail(in_quotes(fields[1]) + " is no number of a source");
  if (!fields.empty()) station.file = file_named(fields[0], files, lines.in());
  return station;
}

}  // namespace

std::vector<Station> read_stations(const fs::path& list, std::span<const fs::path> files,
                                   std::span<const RowLayout> layouts) {
  ListLines lines(list,
                  "a name, x y z, and a file name or a number of a source are needed; a trajectory needs a "
                  "first line that names its columns, such as time x y z");
  std::vector<Station> stations;
  while (const auto fields = lines.next()) {
    stations.push_back(parse_station(*fields, stations.size() + 1, files, lines));
    const Station& added = stations.back();
    const bool is_known = std::any_of(stations.begin(), stations.end() - 1, [&](const Station& other) {
      return other.file == added.file && other.source == added.source;
    });
    if (is_known) lines.fail(added.name + " has the points of an earlier station");
    const auto of_it = added.file ? layouts.subspan(*added.file, 1) : layouts;
    if (added.source && std::ranges::none_of(of_it, source_column))
      lines.in().fail_at_line(lines.in().line(),
                              added.name + " has the number " + std::to_string(*added.source) + ", and " +
                                  (added.file ? files[*added.file].string() + " has no" : "no file has a") +
                                  " column scan or point_source_id");
  }
  if (stations.empty()) lines.fail_empty("names no station");
  return stations;
}

std::vector<double> sources_of(const RowBatch& rows, const RowLayout& layout) {
  std::vector<double> sources;
  if (const Property* const column = source_column(layout))
    load_column(rows, layout.stride, *column, sources);
  return sources;
}

namespace {

constexpr std::size_t kSweptEdge = 63;        // cells of 1.8 degrees; odd, as PathView::kEdge
constexpr double kPause = 10;                 // median intervals
constexpr std::uint64_t kBytesPerLine = 100;  // while a file is read
constexpr double kLatest = 1e20;              // time that is allowed: nanoseconds since 1970 are 2e18
constexpr double kLeastShare = 0.02;  // of the largest count of a cell: others are of turns and rough ground

// Returns how many of the keys, in order, are `key` or less.
std::size_t count_up_to(const std::vector<double>& keys, double key) {
  return static_cast<std::size_t>(std::upper_bound(keys.begin(), keys.end(), key) - keys.begin());
}

// Interpolates the value at `key`, between the values of i - 1 and i.
template <class Value>
Value between(const std::vector<double>& keys, const std::vector<Value>& values, std::size_t i, double key) {
  const double share = (key - keys[i - 1]) / (keys[i] - keys[i - 1]);
  return values[i - 1] + share * (values[i] - values[i - 1]);
}

// Renames the columns of the position, as in headers of scans. Names of the TUM format come last: tx, ty, tz.
PositionNames name_places(std::vector<std::string>& names) {
  if (const PositionNames position = name_position(names); position != PositionNames::kNone) return position;
  for (std::string& name : names)
    if (name == "tx" || name == "ty" || name == "tz") name.erase(0, 1);
  return name_position(names);
}

// Returns the names of the header, or of the last comment before the rows that names a time and a position.
// Returns none if no time is named.
std::vector<std::string> names_with_time(const TextStart& start, const TextPlaces& places) {
  if (places.header) {
    std::vector<std::string> names = column_names(header_cells(start.lines[*places.header].text));
    return find_time(names) ? names : std::vector<std::string>();
  }
  for (auto comment = start.comments.rbegin(); comment != start.comments.rend(); ++comment) {
    const std::vector<std::string> names = column_names(comment_cells(*comment));
    std::vector<std::string> renamed = names;
    if (find_time(names) && name_places(renamed) != PositionNames::kNone) return names;
  }
  return {};
}

using Rows = std::vector<std::pair<double, Eigen::Vector3d>>;  // in ascending time, each time once

double speed_between(const Rows::value_type& a, const Rows::value_type& b) {
  return (b.second - a.second).norm() / std::abs(b.first - a.first);
}

// Returns a speed between the path's speeds and the ones of ways to a wrong place and back; infinity without
// such ways.
double speed_of_jumps(const Rows& rows) {
  constexpr double kOverMedian = 100, kOverOthers = 10;
  std::vector<double> speeds;
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (const double speed = speed_between(rows[i - 1], rows[i]); speed > 0) speeds.push_back(speed);
  std::ranges::sort(speeds);
  for (std::size_t i = speeds.size() / 2 + 1; i < speeds.size(); ++i)
    if (speeds[i] > kOverMedian * speeds[speeds.size() / 2] && speeds[i] > kOverOthers * speeds[i - 1])
      return std::sqrt(speeds[i - 1]) * std::sqrt(speeds[i]);
  return std::numeric_limits<double>::infinity();
}

// Returns the rows that are on the path: from the longest run without a jump on, those to which no jump
// leads. Returns all rows if too many are off it.
Rows rows_on_path(const Rows& rows) {
  constexpr std::size_t kMostOff = 5;  // one of so many
  const double jump = speed_of_jumps(rows);
  std::size_t first = 0, last = 0;
  for (std::size_t begin = 0, i = 1; i <= rows.size(); ++i) {
    if (i < rows.size() && speed_between(rows[i - 1], rows[i]) < jump) continue;
    if (i - begin > last - first) first = begin, last = i;
    begin = i;
  }
  Rows kept;
  for (std::size_t i = first + 1; i-- > 0;)
    if (kept.empty() || speed_between(kept.back(), rows[i]) < jump) kept.push_back(rows[i]);
  std::ranges::reverse(kept);
  for (std::size_t i = first + 1; i < rows.size(); ++i)
    if (speed_between(kept.back(), rows[i]) < jump) kept.push_back(rows[i]);
  return kMostOff * (rows.size() - kept.size()) <= rows.size() ? kept : rows;
}

}  // namespace

Trajectory::Trajectory(std::vector<double> times, std::vector<Eigen::Vector3d> places, LeftOut left_out)
    : times_(std::move(times)), lengths_(times_.size()), places_(std::move(places)), left_out_(left_out) {
  for (std::size_t i = 1; i < places_.size(); ++i)
    lengths_[i] = lengths_[i - 1] + (places_[i] - places_[i - 1]).norm();
  std::vector<double> intervals;
  for (std::size_t i = 1; i < times_.size(); ++i) intervals.push_back(times_[i] - times_[i - 1]);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  longest_interval_ = kPause * *middle;
  for (std::size_t i = 0; i < times_.size(); ++i)
    if (i == 0 || times_[i] - times_[i - 1] > longest_interval_) first_of_parts_.push_back(i);
  first_of_parts_.push_back(times_.size());
}

std::optional<double> Trajectory::length_at(double time) const {
  if (time == last_time()) return length();
  const std::size_t next = count_up_to(times_, time);
  if (next == 0 || next == times_.size()) return std::nullopt;
  const bool is_pause = times_[next] - times_[next - 1] > longest_interval_ && time > times_[next - 1];
  if (is_pause) return std::nullopt;
  return between(times_, lengths_, next, time);
}

Eigen::Vector3d Trajectory::place_at(double length) const {
  const std::size_t next = count_up_to(lengths_, length);
  if (next == 0) return places_.front();
  if (next == places_.size()) return places_.back();
  return between(lengths_, places_, next, length);
}

std::optional<Trajectory> read_trajectory(const std::filesystem::path& file, std::uint64_t memory) {
  constexpr std::size_t kHead = 4096;
  InputFile head(file), in(file);
  if (head.peek(kHead).find('\0') != std::string_view::npos)
    head.fail(
        "is binary, as SBET files are; a list of stations or a trajectory is text, with the columns time, x, "
        "y and z "
        "in the coordinates of the scan; programs for trajectories export it");
  const TextStart start = read_start(head);
  const TextPlaces places = find_places(start.lines);
  std::vector<std::string> names = names_with_time(start, places);
  if (names.empty()) return std::nullopt;
  const std::string given = joined(names);
  if (const PositionNames position = name_places(names); position != PositionNames::kLengths)
    in.fail((position == PositionNames::kNone ? "no columns named x, y and z, but " + given
                                              : "has longitude and latitude: " + given) +
            "; a trajectory has the columns time, x, y and z, in the coordinates of the scan");
  std::array<std::size_t, 4> columns{*find_time(names)};
  for (std::size_t axis = 0; axis < 3; ++axis)
    columns[axis + 1] =
        static_cast<std::size_t>(std::ranges::find(names, std::string(1, "xyz"[axis])) - names.begin());
  Rows records;
  char separator = 0;
  while (const auto line = in.next_line()) {
    const std::string_view row = without_end(without_blanks(*line));
    if (places.row >= start.lines.size() || in.line() < start.lines[places.row].number) continue;
    if (row.empty() || is_comment(row)) continue;
    if (separator == 0) separator = find_separator(row);
    const Cells cells = split(row, separator);
    if (cells.size() != names.size())
      in.fail_at_line(in.line(), "has " + std::to_string(cells.size()) + " columns; the header names " +
                                     std::to_string(names.size()) + ": " + given);
    std::array<double, 4> values;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::string wrong = read_number(cells[columns[i]], i == 0 ? kLatest : kFarthest, values[i]);
      if (!wrong.empty())
        in.fail_at_line(in.line(), wrong + "; numbers are needed in the columns time, x, y and z");
    }
    if (records.size() >= memory / kBytesPerLine)
      in.fail("has more than the " + std::to_string(records.size()) +
              " lines that the memory limit has space for; allowed: fewer lines, such as 100 for each "
              "second, or a larger --memory-limit");
    records.emplace_back(values[0], Eigen::Vector3d(values[1], values[2], values[3]));
  }
  const auto is_earlier = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::stable_sort(records.begin(), records.end(), is_earlier);
  const auto is_same_time = [](const auto& a, const auto& b) { return a.first == b.first; };
  records.erase(std::unique(records.begin(), records.end(), is_same_time), records.end());
  if (records.size() < 2) in.fail("has fewer than two times; a trajectory has two or more");
  const Rows kept = rows_on_path(records);
  std::vector<double> times;
  std::vector<Eigen::Vector3d> path;
  for (const auto& [at, place] : kept) {
    times.push_back(at);
    path.push_back(place);
  }
  const auto off = std::ranges::mismatch(records, kept).in1;  // the first that is not kept
  return Trajectory(std::move(times), std::move(path),
                    {records.size() - kept.size(), off == records.end() ? 0 : off->first});
}

Eigen::Matrix3d Trajectory::axes_at(double length, double reach) const {
  const auto part = std::upper_bound(first_of_parts_.begin() + 1, first_of_parts_.end() - 1, length,
                                     [&](double at, std::size_t first) { return at < lengths_[first]; });
  const double least = lengths_[*(part - 1)], most = lengths_[*part - 1];
  const Eigen::Vector3d chord =
      place_at(std::min(length + reach, most)) - place_at(std::max(length - reach, least));
  const double level = std::sqrt(chord.x() * chord.x() + chord.y() * chord.y());
  Eigen::Matrix3d axes;
  const Eigen::Vector3d forward =
      chord.squaredNorm() > 0 ? Eigen::Vector3d(chord.normalized()) : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d left =
      level > 0 ? Eigen::Vector3d(-chord.y() / level, chord.x() / level, 0) : Eigen::Vector3d::UnitY();
  axes << forward.transpose(), left.transpose(), forward.cross(left).transpose();
  return axes;
}

SweptDirections::SweptDirections() : counts_(6 * kSweptEdge * kSweptEdge) {}

void SweptDirections::add(const Eigen::Vector3d& direction) {
  ++counts_[cell_of(direction, kSweptEdge)];
}

void SweptDirections::finish() {
  const auto most = static_cast<double>(*std::max_element(counts_.begin(), counts_.end()));
  is_swept_.resize(counts_.size());
  for (std::size_t i = 0; i < counts_.size(); ++i) is_swept_[i] = counts_[i] > kLeastShare * most;
}

bool SweptDirections::contains(const Eigen::Vector3d& direction) const {
  return is_swept_[cell_of(direction, kSweptEdge)];
}

}  // namespace lacuna::io
