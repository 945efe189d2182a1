// SPDX-License-Identifier: Apache-2.0
// Checks of a config file before toml++ reads it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace lacuna {

struct TextFault {
  std::size_t line = 0;  // from 1 on
  std::string reason;    // and what is allowed
};

// Returns the first line that toml++ 3.3 may not be given, or nothing. On characters outside of ASCII, the
// library runs into `__builtin_unreachable`. Characters in a comment or a string of one line are the
// exception. A section without a name fails an assertion there.
std::optional<TextFault> find_fault(std::string_view config_text);

}  // namespace lacuna
