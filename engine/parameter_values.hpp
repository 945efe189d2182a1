// SPDX-License-Identifier: Apache-2.0
// Values of parameters as text.
#pragma once

#include "engine/config.hpp"

#include <string>
#include <string_view>
#include <variant>

namespace lacuna {

// Throws `Error` that names the parameter, the given value and the allowed values.
[[noreturn]] void refuse(const Parameter& parameter, std::string_view given);

// Returns whether the value has one of the types `Types`.
template <typename... Types>
bool is_any_of(const Parameter& parameter) {
  return (std::holds_alternative<Types>(parameter.value) || ...);
}

bool in_range(const Parameter& parameter, double value);

// Returns the number as TOML: 1.0, never 1, since the point makes a number a real one in TOML.
std::string print_number(double value);

// Returns the text as a TOML basic string.
std::string quote(std::string_view text);

}  // namespace lacuna
