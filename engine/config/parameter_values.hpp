// SPDX-License-Identifier: Apache-2.0
// Values of parameters as text.
#pragma once

#include "engine/config/config.hpp"

#include <string>
#include <string_view>
#include <variant>

namespace lacuna {

// Throws `Error` that names the parameter, what was given and what is allowed.
[[noreturn]] void refuse(const Parameter& parameter, std::string_view given);

// Whether the value has one of these types.
template <typename... Types>
bool is_any_of(const Parameter& parameter) {
  return (std::holds_alternative<Types>(parameter.value) || ...);
}

bool in_range(const Parameter& parameter, double value);

// As TOML: 1.0, never 1, since the point makes a number a real one in TOML.
std::string print_number(double value);

// A TOML basic string.
std::string quote(std::string_view text);

}  // namespace lacuna
