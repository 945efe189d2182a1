// SPDX-License-Identifier: Apache-2.0
// The config file: TOML, each key in its section. It knows nothing of parameters but their list.
#pragma once

#include "engine/config/parameter.hpp"
#include "engine/export.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace lacuna {

// Sets the values that the text of a file has. Returns its keys. Throws `Error` (file, line, key, what is
// allowed) for unknown keys, wrong types and impossible values; some values are set then.
LACUNA_API std::vector<std::string> read_parameters(const std::string& text,
                                                    const std::filesystem::path& file,
                                                    const std::vector<Parameter>& all);
// The parameters as such a text, a help comment above each key.
LACUNA_API std::string print_parameters(const std::vector<Parameter>& all);

// The text of a file. Throws `Error` where it cannot be read, or has more than 1 MiB.
LACUNA_API std::string read_config_text(const std::filesystem::path& file);

// Sets the values of the file in a config, the engine's or another kind. Returns the file's keys.
// Throws `Error` as `read_parameters` does, and leaves the config as it was then.
template <class AnyConfig>
std::vector<std::string> read_config(const std::filesystem::path& file, AnyConfig& config) {
  AnyConfig changed = config;
  std::vector<std::string> keys = read_parameters(read_config_text(file), file, parameters(changed));
  config = std::move(changed);
  return keys;
}

// The whole config as the text of a file.
template <class AnyConfig>
std::string print_config(AnyConfig config) {
  return print_parameters(parameters(config));
}

}  // namespace lacuna
