// SPDX-License-Identifier: Apache-2.0
// Commands of the program, within Python's process.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace lacuna::python {

// From now on, warnings of commands are collected, and do not get to the console.
void collect_warnings();

// Returns text of the program in Python's words: "--void-rule" is void_rule, `lacuna check` lacuna.check, and
// nothing is said of --help.
std::string in_python_words(const std::string& text);
std::vector<std::string> in_python_words(const std::vector<std::string>& texts);

// Runs `lacuna render` or `lacuna stations` with these arguments. Returns the warnings. What it prints is
// left out. One command runs at a time. Throws `Error`.
std::vector<std::string> run_command(const std::vector<std::string>& arguments);

}  // namespace lacuna::python
