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

// The first line that toml++ 3.3 may not be given, none if all is well: on characters outside of ASCII it
// runs into __builtin_unreachable unless they are in a comment or a string of one line, and on a section
// without a name into an assertion.
std::optional<TextFault> find_fault(std::string_view config_text);

}  // namespace lacuna
