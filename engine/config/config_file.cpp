// SPDX-License-Identifier: Apache-2.0
#include "engine/config/config_file.hpp"

#include "engine/run/error.hpp"
#include "engine/run/machine.hpp"
#include "engine/run/words.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include <toml++/toml.h>

namespace lacuna {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::size_t kLargestConfigFile = 1 << 20;

[[noreturn]] void fail(const std::filesystem::path& file, std::size_t line, const std::string& reason) {
  throw Error(file.string() + ":" + std::to_string(line) + ": " + reason);
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

// Whether a line begins a section, "[" or "[[", with nothing behind that a name can begin with.
bool is_section_without_name(std::string_view line) {
  constexpr const char* kBlanks = " \t";
  std::size_t at = line.find_first_not_of(kBlanks);
  if (at == line.npos || line[at] != '[') return false;
  at = line.find_first_not_of(kBlanks, at + 1);
  if (at != line.npos && line[at] == '[') at = line.find_first_not_of(kBlanks, at + 1);
  return at == line.npos || (std::isalnum(line[at]) == 0 && std::strchr("_-\"'", line[at]) == nullptr);
}

// Returns what is wrong with a line that toml++ 3.3 may not be given. Empty: nothing is wrong. The library
// asserts that a section has a name. It goes down one level for each part of a name. It takes characters
// outside of ASCII in comments and in strings of one line alone.
std::string fault_of(std::string_view line) {
  constexpr std::size_t kMostDots = 15;  // Lacuna's own names have none
  if (!is_utf8(line)) return "is not UTF-8; a config file must be";
  std::string bare;  // without its comment, each string as its first quote
  for (std::size_t dots = 0; !line.empty() && line.front() != '#';) {
    const char c = line.front();
    std::size_t end = 1;
    if (c == '"' || c == '\'') {
      if (line.starts_with(std::string(3, c)))
        return "a string of several lines; strings of one line are allowed";
      while (end < line.size() && line[end] != c) end += line[end] == '\\' && c == '"' ? 2 : 1;
      ++end;
    } else if (c != '\t' && (c < ' ' || c > '~')) {
      return "a character outside of quotes that is not ASCII text; keys and values have none";
    }
    dots = std::strchr(",=[]{}", c) != nullptr ? 0 : dots + (c == '.' ? 1 : 0);
    if (dots > kMostDots) return "a name of more than 16 parts; sections and keys have one part";
    bare += c;
    line.remove_prefix(std::min(end, line.size()));
  }
  return is_section_without_name(bare) ? "a section without a name; [name] is needed" : "";
}

toml::table parse_toml(const std::filesystem::path& file, const std::string& text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  std::istringstream lines(text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('\r')) line.pop_back();
    ++number;
    if (const std::string fault = fault_of(line); !fault.empty()) fail(file, number, fault);
  }
  try {
    return toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    fail(file, error.source().begin.line, std::string(error.description()));
  }
}

Words section_names(const std::vector<Parameter>& all) {
  Words names;
  for (const Parameter& parameter : all) {
    if (names.empty() || names.back() != parameter.section) names.push_back(parameter.section);
  }
  return names;
}

Words key_names(const std::vector<Parameter>& all, std::string_view section) {
  Words names;
  for (const Parameter& parameter : all) {
    if (parameter.section == section) names.push_back(parameter.key);
  }
  return names;
}

const Parameter* find_key(const std::vector<Parameter>& all, std::string_view key) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.key == key; });
  return found == all.end() ? nullptr : &*found;
}

std::string belongs_in(const Parameter& parameter) {
  return " (\"" + std::string(parameter.key) + "\" belongs in [" + std::string(parameter.section) + "])";
}

// These say what is wrong with a key outside of all sections, with a section, and with a key of this section.
std::string stray_key(const std::vector<Parameter>& all, const std::string& key) {
  const Parameter* const known = find_key(all, key);
  return "key \"" + key + "\" is outside of a section" + (known ? belongs_in(*known) : "") +
         "; allowed: " + listed(section_names(all));
}

std::string unknown_section(const std::vector<Parameter>& all, const std::string& name) {
  const Words sections = section_names(all);
  return "unknown section \"" + name + "\"" + suggestion(name, sections) + "; allowed: " + listed(sections);
}

std::string unknown_key(const std::vector<Parameter>& all, const std::string& section,
                        const std::string& key) {
  const Words keys = key_names(all, section);
  const Parameter* const elsewhere = find_key(all, key);
  return "unknown key \"" + key + "\" in [" + section + "]" +
         (elsewhere ? belongs_in(*elsewhere) : suggestion(key, keys)) + "; allowed there: " + listed(keys);
}

// Shows a value in an error message. Numbers and flags look as on the command line. Strings have quotes.
std::string shown(const toml::node& node) {
  if (node.is_table()) return "{...}";
  if (node.is_array()) return "[...]";
  if (const auto text = node.value_exact<std::string>()) return quote(*text);
  if (const auto number = node.value_exact<std::int64_t>()) return std::to_string(*number);
  if (const auto number = node.value_exact<double>()) return print_number(*number);
  std::ostringstream out;
  node.visit([&out](const auto& value) { out << value; });
  return out.str();
}

// Sets the parameter from the text of a value, once the value has the type of the parameter.
void set(const Parameter& parameter, const toml::node& node) {
  const bool is_text = is_any_of<std::string*>(parameter);
  const bool is_list = is_any_of<std::vector<double>*>(parameter);
  const bool may_be_text = is_text || is_any_of<NamedValue, std::uint64_t*>(parameter);
  if (may_be_text && node.is_string()) {
    parameter.set(node.ref<std::string>());
  } else if (is_list && node.is_array()) {
    std::string list;
    for (const toml::node& entry : *node.as_array()) list += (list.empty() ? "" : ", ") + shown(entry);
    parameter.set(list);
  } else if (is_list || is_text) {
    refuse(parameter, shown(node));
  } else {
    parameter.set(shown(node));
  }
}

}  // namespace

std::string read_config_text(const std::filesystem::path& file) {
  check_regular_file(file, "a config file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file.string() + ": cannot be opened: " + std::strerror(errno));
  std::string text(kLargestConfigFile + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) throw Error(file.string() + ": cannot read the config file: " + std::strerror(errno));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kLargestConfigFile) throw Error(file.string() + ": too large for a config file (1 MiB)");
  return text;
}

std::vector<std::string> read_parameters(const std::string& text, const std::filesystem::path& file,
                                         const std::vector<Parameter>& all) {
  std::vector<std::string> keys;
  for (const auto& [section, content] : parse_toml(file, text)) {
    const std::string in(section.str());
    const toml::table* const table = content.as_table();
    if (!table) fail(file, section.source().begin.line, stray_key(all, in));
    if (key_names(all, in).empty()) fail(file, section.source().begin.line, unknown_section(all, in));
    for (const auto& [key, node] : *table) {
      const std::size_t line = key.source().begin.line;
      const Parameter* const parameter = find_key(all, key.str());
      if (!parameter || parameter->section != in)
        fail(file, line, unknown_key(all, in, std::string(key.str())));
      try {
        set(*parameter, node);
      } catch (const Error& error) {
        fail(file, line, error.what());
      }
      keys.emplace_back(key.str());
    }
  }
  return keys;
}

std::string print_parameters(const std::vector<Parameter>& all) {
  std::ostringstream text;
  text << "# Parameters of a run of lacuna. Command line over config file over defaults.\n";
  std::string_view section;
  for (const Parameter& parameter : all) {
    text << '\n';
    if (parameter.section != section) {
      section = parameter.section;
      text << '[' << section << "]\n";
    }
    if (parameter.in_file_only) text << "# Not for ordinary use: no option of the command line sets it.\n";
    text << "# " << parameter.help << "\n# Allowed: " << parameter.allowed << ".\n"
         << parameter.key << " = " << parameter.print() << '\n';
  }
  return text.str();
}

}  // namespace lacuna
