// SPDX-License-Identifier: Apache-2.0
#include "engine/parts/reason.hpp"

#include "engine/store/sealed_part.hpp"

#include <algorithm>
#include <optional>
#include <system_error>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

constexpr const char* kChecksum = "part ";  // how a line begins that has one

// Returns the first of `lines` that is not among `others`.
std::string first_other(const std::vector<std::string>& lines, const std::vector<std::string>& others) {
  const auto is_other = [&](const std::string& line) { return std::ranges::count(others, line) == 0; };
  const auto found = std::ranges::find_if(lines, is_other);
  return found == lines.end() ? "nothing" : *found;
}

}  // namespace

std::string Reason::words() const {
  switch (why) {
    case Why::kNew:
      return "new";
    case Why::kUnusable:
      return "its files are incomplete, or its tiles too large";
    case Why::kDamaged:
      return "damaged";
    case Why::kFollows:
      return "a step before it has changed";
    case Why::kInput:
    case Why::kParameter:
      break;
  }
  return "\"" + was + "\" is \"" + is + "\" now";
}

Reason reason_of(const fs::path& file, const std::string& made_from) {
  using Why = Reason::Why;
  std::error_code error;
  if (!fs::exists(file, error)) return {Why::kNew, "", ""};
  const std::optional<PartReader> part = PartReader::open(file, std::nullopt);
  const std::optional<std::string> before = part ? part->made_from() : std::nullopt;
  if (!before) return {Why::kDamaged, "", ""};
  if (*before == made_from) return {Why::kUnusable, "", ""};
  auto [was, is] = first_difference(*before, made_from);
  const Why why = is.starts_with(kChecksum)  ? Why::kFollows
                  : is.starts_with("input:") ? Why::kInput
                                             : Why::kParameter;
  return {why, std::move(was), std::move(is)};
}

std::string line_of(const Digest& checksum) {
  return kChecksum + std::to_string(checksum[0]) + " " + std::to_string(checksum[1]) + "\n";
}

std::vector<std::string> split(std::string_view text, char end) {
  std::vector<std::string> parts;
  for (std::size_t at; (at = text.find(end)) != std::string_view::npos; text.remove_prefix(at + 1))
    parts.emplace_back(text.substr(0, at));
  return parts;
}

std::pair<std::string, std::string> first_difference(const std::string& was, const std::string& is) {
  const std::vector<std::string> before = split(was, '\n'), now = split(is, '\n');
  return {first_other(before, now), first_other(now, before)};
}

}  // namespace lacuna
