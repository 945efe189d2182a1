// SPDX-License-Identifier: Apache-2.0
#include "io/read/crs/crs_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <span>

namespace lacuna::io {
namespace {

constexpr std::array<std::string_view, 3> kGeographic = {"GEOGCS", "GEOGCRS", "GEOGRAPHICCRS"};
constexpr std::array<std::string_view, 2> kGeodetic = {"GEODCRS", "GEODETICCRS"};  // geographic or geocentric
constexpr std::array<std::string_view, 13> kHorizontal = {
    "PROJCS",  "PROJCRS",     "PROJECTEDCRS", "DERIVEDPROJCRS", "GEOGCS", "GEOGCRS",       "GEOGRAPHICCRS",
    "GEODCRS", "GEODETICCRS", "GEOCCS",       "LOCAL_CS",       "ENGCRS", "ENGINEERINGCRS"};
constexpr std::array<std::string_view, 3> kVertical = {"VERT_CS", "VERTCRS", "VERTICALCRS"};
constexpr std::array<std::string_view, 1> kAxes = {"CS"};
constexpr std::array<std::string_view, 2> kUnitKeywords = {"UNIT", "LENGTHUNIT"};
constexpr std::array<std::string_view, 1> kGeocentric = {"GEOCCS"};

bool is_equal(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char left, unsigned char right) {
    return std::toupper(left) == std::toupper(right);
  });
}

bool is_one_of(std::string_view keyword, std::span<const std::string_view> keywords) {
  return std::any_of(keywords.begin(), keywords.end(),
                     [&](std::string_view known) { return is_equal(keyword, known); });
}

bool is_of_keyword(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::string_view keyword_of(std::string_view node) {
  const auto end = std::find_if_not(node.begin(), node.end(), is_of_keyword);
  return node.substr(0, static_cast<std::size_t>(end - node.begin()));
}

// Returns the first `KEYWORD[...]` with one of the keywords, wherever it is, or the last one. Names in quotes
// do not count. Blanks may come before the bracket.
std::string_view find_node(std::string_view text, std::span<const std::string_view> keywords,
                           bool is_last = false) {
  std::size_t begin = text.npos, end = text.npos, word = 0, word_end = 0;
  int depth = 0, depth_of_node = 0;
  bool is_quoted = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"') is_quoted = !is_quoted;
    if (is_quoted) continue;
    if (is_of_keyword(c)) {
      if (at == 0 || !is_of_keyword(text[at - 1])) word = at;
      word_end = at + 1;
    } else if (c == '[' || c == '(') {
      const bool may_begin = begin == text.npos || (is_last && end != text.npos);
      if (may_begin && is_one_of(text.substr(word, word_end - word), keywords)) {
        begin = word;
        end = text.npos;
        depth_of_node = depth;
      }
      ++depth;
    } else if (c == ']' || c == ')') {
      --depth;
      if (begin == text.npos || end != text.npos || depth != depth_of_node) continue;
      end = at + 1;
      if (!is_last) break;
    } else if (std::isspace(static_cast<unsigned char>(c)) == 0) {
      word = word_end = at + 1;
    }
  }
  return begin == text.npos ? std::string_view() : text.substr(begin, std::min(end, text.size()) - begin);
}

}  // namespace

std::string_view horizontal_system(std::string_view crs) {
  return find_node(crs, kHorizontal);
}

std::string_view vertical_system(std::string_view crs) {
  return find_node(crs, kVertical);
}

bool is_code(std::string_view text) {
  const std::size_t colon = text.find(':');
  return colon != text.npos && colon > 0 && colon + 1 < text.size() &&
         text.find_first_not_of("0123456789+", colon + 1) == text.npos &&
         std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](unsigned char c) { return std::isalpha(c) != 0; });
}

bool is_utm(std::string_view crs) {
  if (!is_code(crs)) {
    const std::string_view system = horizontal_system(crs);
    return system.substr(0, system.find(',')).find("UTM zone") != system.npos;
  }
  constexpr std::string_view kEpsg = "EPSG:";
  constexpr std::array<std::array<int, 2>, 4> kZones = {
      {{32601, 32660}, {32701, 32760}, {25828, 25838}, {26901, 26923}}};  // WGS 84, ETRS89, NAD83
  int code = 0;
  if (crs.starts_with(kEpsg)) std::from_chars(crs.data() + kEpsg.size(), crs.data() + crs.size(), code);
  return std::any_of(kZones.begin(), kZones.end(),
                     [&](const auto& zones) { return code >= zones[0] && code <= zones[1]; });
}

std::string_view without_vertical(std::string_view crs) {
  return is_code(crs) ? crs.substr(0, crs.find('+')) : horizontal_system(crs);
}

std::string name_of_crs(const std::string& crs) {
  const std::size_t begin = crs.find('"'), end = crs.find('"', begin + 1);
  return end == crs.npos ? crs : crs.substr(begin + 1, end - begin - 1);
}

// It is the last node of the system, such as AUTHORITY["EPSG","25832"]] or ID["EPSG",25832]].
std::string own_code(std::string_view system) {
  constexpr std::string_view kEpsg = "\"EPSG\"";
  const std::size_t at = system.rfind(kEpsg);
  if (at == system.npos) return "";
  std::string rest(system.substr(at + kEpsg.size()));
  std::erase_if(rest, [](char c) { return c == '"' || c == ',' || c == ' '; });
  const std::size_t end = rest.find_first_not_of("0123456789");
  return end != rest.npos && rest.substr(end) == "]]" ? "EPSG:" + rest.substr(0, end) : "";
}

std::string_view unit_node(std::string_view system) {
  return find_node(system, kUnitKeywords, true);
}

namespace {

// Whether a geodetic system has axes of this kind.
bool has_axes(std::string_view system, std::string_view kind) {
  if (!is_one_of(keyword_of(system), kGeodetic)) return false;
  const std::string_view axes = find_node(system, kAxes);
  const auto begin =
      std::find_if(axes.begin() + std::min<std::ptrdiff_t>(2, std::ssize(axes)), axes.end(), is_of_keyword);
  return is_equal(keyword_of({begin, axes.end()}), kind);
}

}  // namespace

bool is_geographic(std::string_view crs) {
  const std::string_view system = horizontal_system(crs);
  return is_one_of(keyword_of(system), kGeographic) || has_axes(system, "ellipsoidal");
}

bool is_geocentric(std::string_view crs) {
  const std::string_view system = horizontal_system(crs);
  return is_one_of(keyword_of(system), kGeocentric) || has_axes(system, "Cartesian");
}

}  // namespace lacuna::io
