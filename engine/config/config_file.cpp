// SPDX-License-Identifier: Apache-2.0
#include "engine/config/config_file.hpp"

#include "engine/config/config_text.hpp"
#include "engine/run/error.hpp"
#include "engine/run/regular_file.hpp"
#include "engine/run/words.hpp"

#include <algorithm>
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

toml::table parse_toml(const std::filesystem::path& file, const std::string& text) {
  if (const auto fault = find_fault(text)) fail(file, fault->line, fault->reason);
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
      if (parameter.is_constant)
        text << "# Constants of the method, not for ordinary use. No option of the command line sets "
                "them.\n\n";
    }
    text << "# " << parameter.help << "\n# Allowed: " << parameter.allowed << ".\n"
         << parameter.key << " = " << parameter.print() << '\n';
  }
  return text.str();
}

}  // namespace lacuna
