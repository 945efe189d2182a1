// SPDX-License-Identifier: Apache-2.0
#include "engine/run/words.hpp"

#include <algorithm>
#include <numeric>

namespace lacuna {
namespace {

// Returns the number of characters to insert, remove or replace to turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string listed(const std::vector<std::string_view>& words) {
  std::string list;
  for (const std::string_view word : words) {
    if (!list.empty()) list += ", ";
    list += word;
  }
  return list;
}

std::string suggestion(std::string_view word, const std::vector<std::string_view>& words) {
  const auto text_of = [](std::string_view meant) {
    return " (did you mean \"" + std::string(meant) + "\"?)";
  };
  const auto begins_with_it = [&](std::string_view other) { return other.starts_with(word); };
  const auto longer = std::ranges::find_if(words, begins_with_it);
  if (word.size() > 1 && longer != words.end()) return text_of(*longer);
  const auto is_most_of_it = [&](std::string_view other) {  // "--out" of "--output"
    return word.starts_with(other) && 2 * other.size() > word.size();
  };
  if (const auto most = std::ranges::find_if(words, is_most_of_it); most != words.end())
    return text_of(*most);

  std::string_view closest;
  std::size_t least = 3;  // a swap of two characters costs 2
  for (const std::string_view candidate : words) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least && distance < candidate.size()) {
      least = distance;
      closest = candidate;
    }
  }
  return closest.empty() ? "" : text_of(closest);
}

}  // namespace lacuna
