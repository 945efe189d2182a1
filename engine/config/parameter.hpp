// SPDX-License-Identifier: Apache-2.0
// A parameter by name, and its value as text. A config is a struct with a function `parameters` that lists
// its parameters. The engine has one (config.hpp); the config of runs on files (io/read/options) adds to it.
#pragma once

#include "engine/export.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lacuna {

// A value of an enumeration, by the names of all.
struct NamedValue {
  std::uint8_t* value;
  std::span<const std::string_view> names;
};

// `names`: in the order of the enumeration.
template <class Enum>
NamedValue named(Enum& value, std::span<const std::string_view> names) {
  static_assert(sizeof(Enum) == sizeof(std::uint8_t));
  return {reinterpret_cast<std::uint8_t*>(&value), names};
}

// What a parameter changes of the data that a run keeps, so that another run may take them over.
enum class Changes : std::uint8_t {
  kPoints,       // the points of a level: a run with another value is another run
  kEvaluation,   // what is found at each point
  kOutputs,      // which results of evaluated points are kept
  kNothingKept,  // no kept data, only results that are made from it: the selection, files, a report
  kProcess,      // no result: threads, memory and temporary files of one process
};

// One line of a list: `[section] key = value`, on the command line `--key` with dashes.
struct Parameter {
  using Value = std::variant<std::int64_t*, double*, bool*, std::string*, std::uint64_t*,
                             std::vector<double>*, NamedValue>;
  std::string_view section;
  std::string_view key;
  Changes changes;
  Value value;  // points into the config it was listed from; uint64_t: a size in bytes
  double min;   // of lists: of each number
  double max;
  std::string_view allowed;  // for error messages: "a whole number from 1 to 1000"
  std::string_view help;
  std::string_view missing = "";  // options without which it changes nothing in this config; empty: it does
  bool in_file_only = false;      // no option of the command line

  LACUNA_API std::string option() const;  // "--tile-points"
  LACUNA_API std::string print() const;   // as in the config file
  // Sets the value from text as on the command line. Throws `Error` naming the key and what is allowed.
  LACUNA_API void set(std::string_view text) const;
};

// Returns a parameter that is true or false.
inline Parameter flag(std::string_view section, std::string_view key, Changes changes, bool* value,
                      std::string_view help, std::string_view missing = "") {
  return {section, key, changes, value, 0, 1, "true or false", help, missing};
}

// Whether the value has one of these types.
template <typename... Types>
bool is_any_of(const Parameter& parameter) {
  return (std::holds_alternative<Types>(parameter.value) || ...);
}

// Throws `Error` that names the parameter, what was given and what is allowed.
[[noreturn]] void refuse(const Parameter& parameter, std::string_view given);

// Refuses the first value that is out of its range.
LACUNA_API void check_ranges(const std::vector<Parameter>& all);

// As TOML: 1.0, never 1, since the point makes a number a real one in TOML.
std::string print_number(double value);

// A TOML basic string.
std::string quote(std::string_view text);

// "512MiB", "2GiB", "1500000" and back.
LACUNA_API std::optional<std::uint64_t> parse_bytes(std::string_view text);
LACUNA_API std::string print_bytes(std::uint64_t bytes);

}  // namespace lacuna
