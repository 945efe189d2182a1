// SPDX-License-Identifier: Apache-2.0
#include "io/stations/station.hpp"

#include "io/input_file.hpp"
#include "io/number.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace lacuna::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kNeeded = "a name, x y z, and a file name or a number of a source are needed";

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  constexpr std::string_view kDivisors = " \t\r,;";
  for (std::size_t begin; (begin = line.find_first_not_of(kDivisors)) != line.npos;) {
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(kDivisors), line.size());
    fields.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return fields;
}

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

Station parse_station(std::span<const std::string_view> fields, std::span<const fs::path> files,
                      const InputFile& in) {
  if (fields.size() < 4 || fields.size() > 6) in.fail_at_line(in.line(), std::string(kNeeded));
  Station station{.name = std::string(fields[0])};
  for (std::size_t i = 0; i < 3; ++i) {
    double& number = station.place[static_cast<Eigen::Index>(i)];
    if (!parse_number(fields[i + 1], number) || !std::isfinite(number))
      in.fail_at_line(in.line(), in_quotes(fields[i + 1]) + " is not a number; " + std::string(kNeeded));
  }
  fields = fields.subspan(4);
  if (fields.empty()) return station;
  if (std::uint32_t source = 0; parse_number(fields.back(), source)) {
    station.source = source;
    fields = fields.first(fields.size() - 1);
  }
  if (fields.size() > 1) in.fail_at_line(in.line(), in_quotes(fields[1]) + " is no number of a source");
  if (!fields.empty()) station.file = file_named(fields[0], files, in);
  return station;
}

bool is_header(std::span<const std::string_view> fields) {
  double number = 0;
  return std::none_of(fields.begin(), fields.end(),
                      [&](std::string_view field) { return parse_number(field, number); });
}

}  // namespace

std::vector<Station> read_stations(const fs::path& list, std::span<const fs::path> files) {
  InputFile in(list);
  std::vector<Station> stations;
  bool is_first = true;
  while (const auto line = in.next_line()) {
    const std::vector<std::string_view> fields = fields_of(*line);
    if (fields.empty() || fields[0].starts_with('#')) continue;
    const bool is_skipped = std::exchange(is_first, false) && is_header(fields);
    if (is_skipped) continue;
    stations.push_back(parse_station(fields, files, in));
    const Station& added = stations.back();
    const bool is_known = std::any_of(stations.begin(), stations.end() - 1, [&](const Station& other) {
      return other.file == added.file && other.source == added.source;
    });
    if (is_known)
      in.fail_at_line(in.line(),
                      added.name + " has the points of an earlier station; " + std::string(kNeeded));
  }
  if (stations.empty()) in.fail("names no station; on each line, " + std::string(kNeeded));
  return stations;
}

}  // namespace lacuna::io
