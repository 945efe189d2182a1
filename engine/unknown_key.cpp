#include "engine/unknown_key.hpp"

#include <algorithm>
#include <numeric>

namespace lacuna {
namespace {

// Number of characters to insert, remove or replace to turn one word into the other.
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

std::string join(const std::vector<std::string_view>& words) {
  std::string joined;
  for (const std::string_view word : words) {
    if (!joined.empty()) joined += ", ";
    joined += word;
  }
  return joined;
}

std::vector<std::string_view> section_names(const std::vector<Parameter>& all) {
  std::vector<std::string_view> names;
  for (const Parameter& parameter : all) {
    if (names.empty() || names.back() != parameter.section) names.push_back(parameter.section);
  }
  return names;
}

std::vector<std::string_view> key_names(const std::vector<Parameter>& all, std::string_view section) {
  std::vector<std::string_view> names;
  for (const Parameter& parameter : all) {
    if (parameter.section == section) names.push_back(parameter.key);
  }
  return names;
}

std::string belongs_in(const Parameter& parameter) {
  return "\"" + std::string(parameter.key) + "\" belongs in [" + std::string(parameter.section) + "]";
}

}  // namespace

std::string suggestion(std::string_view word, const std::vector<std::string_view>& words) {
  std::string_view closest;
  std::size_t least = 3;  // a swap of two characters costs 2
  for (const std::string_view candidate : words) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least && distance < candidate.size()) {
      least = distance;
      closest = candidate;
    }
  }
  return closest.empty() ? "" : " (did you mean \"" + std::string(closest) + "\"?)";
}

const Parameter* find_key(const std::vector<Parameter>& all, std::string_view key) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.key == key; });
  return found == all.end() ? nullptr : &*found;
}

bool is_section(const std::vector<Parameter>& all, std::string_view name) {
  return !key_names(all, name).empty();
}

std::string unknown_key(const std::vector<Parameter>& all, std::string_view section, std::string_view key) {
  const std::vector<std::string_view> keys = key_names(all, section);
  const Parameter* elsewhere = find_key(all, key);
  const std::string hint = elsewhere ? " (" + belongs_in(*elsewhere) + ")" : suggestion(key, keys);
  return "unknown key \"" + std::string(key) + "\" in [" + std::string(section) + "]" + hint +
         "; allowed there: " + join(keys);
}

std::string unknown_section(const std::vector<Parameter>& all, std::string_view name, bool is_table) {
  const std::vector<std::string_view> sections = section_names(all);
  const std::string quoted = "\"" + std::string(name) + "\"";
  if (is_table) {
    return "unknown section " + quoted + suggestion(name, sections) + "; allowed: " + join(sections);
  }
  const Parameter* parameter = find_key(all, name);
  const std::string hint = parameter ? " (" + belongs_in(*parameter) + ")" : "";
  return "key " + quoted + " is outside of a section" + hint + "; allowed: " + join(sections);
}

}  // namespace lacuna
