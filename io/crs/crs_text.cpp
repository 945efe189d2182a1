// SPDX-License-Identifier: Apache-2.0
#include "io/crs/crs_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>

namespace lacuna::io {
namespace {

constexpr std::array<std::string_view, 3> kGeographic = {"GEOGCS", "GEOGCRS", "GEOGRAPHICCRS"};
constexpr std::array<std::string_view, 2> kGeodetic = {"GEODCRS", "GEODETICCRS"};  // geographic or geocentric
constexpr std::array<std::string_view, 13> kHorizontal = {
    "PROJCS",  "PROJCRS",     "PROJECTEDCRS", "DERIVEDPROJCRS", "GEOGCS", "GEOGCRS",       "GEOGRAPHICCRS",
    "GEODCRS", "GEODETICCRS", "GEOCCS",       "LOCAL_CS",       "ENGCRS", "ENGINEERINGCRS"};
constexpr std::array<std::string_view, 1> kAxes = {"CS"};

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

// Returns the first `KEYWORD[...]` with one of the keywords, wherever it is. Names in quotes do not count.
std::string_view find_node(std::string_view text, std::span<const std::string_view> keywords) {
  std::size_t begin = text.npos, word = 0;
  int depth = 0, depth_of_node = 0;
  bool is_quoted = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"') is_quoted = !is_quoted;
    if (is_quoted) continue;
    if (c == '[' || c == '(') {
      if (begin == text.npos && is_one_of(text.substr(word, at - word), keywords)) {
        begin = word;
        depth_of_node = depth;
      }
      ++depth;
    }
    if (c == ']' || c == ')') {
      --depth;
      if (begin != text.npos && depth == depth_of_node) return text.substr(begin, at + 1 - begin);
    }
    if (!is_of_keyword(c)) word = at + 1;
  }
  return begin == text.npos ? std::string_view() : text.substr(begin);
}

}  // namespace

std::string_view horizontal_system(std::string_view crs) {
  return find_node(crs, kHorizontal);
}

bool is_geographic(std::string_view crs) {
  const std::string_view system = horizontal_system(crs), keyword = keyword_of(system);
  if (is_one_of(keyword, kGeographic)) return true;
  constexpr std::string_view kEllipsoidal = "ellipsoidal";
  const std::string_view axes = find_node(system, kAxes);
  return is_one_of(keyword, kGeodetic) && axes.size() > 3 &&
         is_equal(axes.substr(3, kEllipsoidal.size()), kEllipsoidal);
}

}  // namespace lacuna::io
