// SPDX-License-Identifier: Apache-2.0
// The manual page lacuna(1).
#pragma once

#include "tools/reference/command_tree.hpp"

#include <string>

namespace lacuna::tools {

// The page as troff with the macros of man(7). `date`: as 2026-01-31.
std::string print_man_page(const CommandEntry& program, const std::string& version, const std::string& date);

}  // namespace lacuna::tools
