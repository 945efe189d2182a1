// SPDX-License-Identifier: Apache-2.0
// Commands of the program, within Python's process.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace lacuna::python {

// From now on, warnings of commands are collected, and do not get to the console.
void collect_warnings();

// Runs `lacuna render` or `lacuna stations` with these arguments. Returns the warnings. What it prints is
// left out. One command runs at a time. Throws `Error`.
std::vector<std::string> run_command(const std::vector<std::string>& arguments);

}  // namespace lacuna::python
