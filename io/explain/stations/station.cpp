// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/station.hpp"

#include "io/read/files/number.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/text/text_lines.hpp"

#include <algorithm>
#include <cmath>
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

}  // namespace lacuna::io
