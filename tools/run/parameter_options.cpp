// SPDX-License-Identifier: Apache-2.0
#include "tools/run/parameter_options.hpp"

#include "engine/run/error.hpp"
#include "tools/console/terminal.hpp"
#include "tools/run/config_files.hpp"
#include "tools/run/own_process.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace lacuna::tools {
using namespace io;

namespace {

bool is_named(const Parameter& parameter, const std::vector<std::string_view>& names) {
  return std::ranges::any_of(
      names, [&](std::string_view name) { return name == parameter.section || name == parameter.key; });
}

// Takes the value of the same parameter of another config.
struct Take {
  const Parameter::Value& from;

  template <class T>
  void operator()(T* to) const {
    *to = *std::get<T*>(from);
  }
  void operator()(const NamedValue& to) const { *to.value = *std::get<NamedValue>(from).value; }
};

struct TypeName {
  std::string operator()(const std::int64_t*) const { return "N"; }
  std::string operator()(const double*) const { return "X"; }
  std::string operator()(const bool*) const { return ""; }
  std::string operator()(const std::string*) const { return "TEXT"; }
  std::string operator()(const std::uint64_t*) const { return "SIZE"; }
  std::string operator()(const std::vector<double>*) const { return "X,X..."; }
  std::string operator()(const NamedValue& value) const {
    std::string names;
    for (const std::string_view name : value.names) names += (names.empty() ? "" : "|") + std::string(name);
    return names;
  }
};

std::string type_name(const Parameter& parameter) {
  return parameter.key == "workspace" || parameter.key == "scratch" ? "DIR"
                                                                    : std::visit(TypeName{}, parameter.value);
}

}  // namespace

bool ReadParameters::has(const Parameter& parameter) const {
  return is_named(parameter, common) || is_named(parameter, rare);
}

ReadParameters parameters_of_run() {
  return {.common = {"min_hole", "k", "min_confidence", "holes_only", "bounds", "where", "crs", "unit",
                     "points", "gpkg", "stations", "report", "workspace", "memory_limit"},
          .rare = {"scale", "neighbourhood", "normals", "criteria", "coherence", "loops", "spanning",
                   "tangential", "selection", "input", "area", "output", "run"}};
}

ReadParameters parameters_of_check() {
  return {.common = {"area", "report", "bounds", "where", "memory_limit"}, .rare = {"input", "threads"}};
}

ReadParameters parameters_of_info() {
  return {.common = {"min_hole", "bounds", "where", "stations", "memory_limit"},
          .rare = {"resolution", "input", "threads", "tile_points", "scratch"}};
}

ReadParameters parameters_of_process() {
  return {.common = {"memory_limit"}, .rare = {"threads", "scratch"}, .has_config_file = false};
}

ParameterOptions::ParameterOptions(const Command& command, const ReadParameters& read) {
  if (read.has_config_file)
    command
        .add_option(
            "--config", config_file_,
            "Config file (TOML), or the name of one that is installed; options of the command line override "
            "it")
        .type("CONFIG");
  FilesConfig defaults;
  for (const Parameter& parameter : parameters(defaults)) {
    Given& given = given_.emplace_back();
    given.is_read = read.has(parameter);
    if (!given.is_read || parameter.is_constant) continue;
    const bool is_flag = std::holds_alternative<bool*>(parameter.value);
    const std::string help(parameter.help);
    const Option option =
        is_flag ? command.add_flag(parameter.option(), given.text, help)
                : command.add_option(parameter.option(), given.text,
                                     help + " Allowed: " + std::string(parameter.allowed) + ".");
    option.type(type_name(parameter)).section(std::string(parameter.section));
    if (!is_named(parameter, read.common)) option.rare();
    if (parameter.key == "leave_out" || parameter.key == "classes") {
      option.joined_by_comma();  // one box, or one file, each
    } else {
      option.once();
    }
    if (!is_flag) option.show_default(parameter.print());
    given.option = option;
  }
}

std::string ParameterOptions::take_file(FilesConfig& config, std::vector<std::string>& keys) const {
  if (config_file_.empty()) return "";
  try {
    const std::string file = find_config(config_file_).string();
    FilesConfig in_file = config;
    keys = read_config(file, in_file);
    const std::vector<Parameter> all = parameters(config), found = parameters(in_file);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (given_[i].is_read) std::visit(Take{found[i].value}, all[i].value);
    }
    return file;
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
}

EffectiveConfig ParameterOptions::read(FilesConfig config) const {
  std::vector<std::string> keys_in_file;
  const std::string file = take_file(config, keys_in_file);
  const std::vector<Parameter> all = parameters(config);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!given_[i].is_given()) continue;
    try {
      std::string text = given_[i].text;
      if (all[i].key == "columns") std::ranges::replace(text, ',', ' ');
      all[i].set(text);
    } catch (const Error& error) {
      throw WrongOption(all[i].option(), error.what());
    }
  }
  try {
    check_config(config);
  } catch (const Error& error) {
    if (file.empty()) throw WrongOption(std::string(error.what()));
    throw UsageError(file + " with the command line: " + error.what());
  }
  return {config, idle_warnings(config, keys_in_file)};
}

FilesConfig ParameterOptions::start(FilesConfig base) const {
  auto [config, warnings] = read(std::move(base));
  print_warnings(warnings);
  prepare_process(config.run);
  return config;
}

std::vector<std::string> ParameterOptions::idle_warnings(FilesConfig config,
                                                         const std::vector<std::string>& keys_in_file) const {
  FilesConfig defaults;
  const std::vector<Parameter> all = parameters(config), unchanged = parameters(defaults);
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!given_[i].is_read || all[i].missing.empty()) continue;
    const bool in_file =
        std::find(keys_in_file.begin(), keys_in_file.end(), all[i].key) != keys_in_file.end();
    const std::string effect = " changes nothing without " + std::string(all[i].missing);
    if (given_[i].is_given()) {
      warnings.push_back(all[i].option() + effect);
    } else if (in_file && all[i].print() != unchanged[i].print()) {
      warnings.push_back(config_file_ + ": " + std::string(all[i].key) + effect);
    }
  }
  return warnings;
}

}  // namespace lacuna::tools
