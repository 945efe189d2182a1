// SPDX-License-Identifier: Apache-2.0
#include "engine/config/config_text.hpp"

#include "engine/run/utf8.hpp"

#include <algorithm>

namespace lacuna {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr std::string_view kBlanks = " \t";

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string_view without_blanks(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(kBlanks), text.size()));
}

// Returns whether a line is "[", or "[[" of an array of tables, with nothing behind that a name can begin
// with.
bool is_section_without_name(std::string_view line) {
  line = without_blanks(line);
  if (!line.starts_with('[')) return false;
  line = without_blanks(line.substr(1));
  if (line.starts_with('[')) line = without_blanks(line.substr(1));
  if (line.empty()) return true;
  const char c = line.front();
  const bool is_letter = ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z');
  return !is_letter && !('0' <= c && c <= '9') && std::string_view("_-\"'").find(c) == std::string_view::npos;
}

// Returns a line without its strings and its comment, and nothing where a string of more lines begins.
std::optional<std::string> bare_text(std::string_view line) {
  std::string bare;
  while (!line.empty() && line.front() != '#') {
    const char quote = line.front();
    if (quote != '"' && quote != '\'') {
      bare += quote;
      line.remove_prefix(1);
      continue;
    }
    if (line.starts_with(std::string(3, quote))) return std::nullopt;
    std::size_t end = 1;
    while (end < line.size() && line[end] != quote) end += line[end] == '\\' && quote == '"' ? 2 : 1;
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return bare;
}

// toml++ goes down one level for each part of a dotted name, without a bound of its own.
bool is_name_too_deep(std::string_view bare) {
  constexpr std::ptrdiff_t kMostDots = 15;  // Lacuna's own names have none
  while (!bare.empty()) {
    const std::size_t end = std::min(bare.find_first_of(",=[]{}"), bare.size());
    const std::string_view name = bare.substr(0, end);
    if (std::count(name.begin(), name.end(), '.') > kMostDots) return true;
    bare.remove_prefix(std::min(end + 1, bare.size()));
  }
  return false;
}

// Returns what is wrong with the line. Empty: nothing is wrong.
std::string fault_of(std::string_view line) {
  if (!is_utf8(line)) return "is not UTF-8; a config file must be";
  if (is_section_without_name(line)) return "a section without a name; [name] is needed";
  const auto bare = bare_text(line);
  if (!bare) return "a string of several lines; strings of one line are allowed";
  if (is_name_too_deep(*bare)) return "a name of more than 16 parts; sections and keys have one part";
  const auto is_allowed = [](char c) { return c == '\t' || (c >= ' ' && c <= '~'); };
  if (std::all_of(bare->begin(), bare->end(), is_allowed)) return "";
  return "a character outside of quotes that is not ASCII text; keys and values have none";
}

}  // namespace

std::optional<TextFault> find_fault(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, length);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (std::string reason = fault_of(line); !reason.empty()) return TextFault{number, std::move(reason)};
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return std::nullopt;
}

}  // namespace lacuna
