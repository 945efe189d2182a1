// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/list_lines.hpp"

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

}  // namespace lacuna::io
