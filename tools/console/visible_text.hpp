// SPDX-License-Identifier: Apache-2.0
// Names and messages come from files of others. A control character among them could move the cursor, change
// the title or send keys. So no control character reaches the terminal.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace lacuna::tools {

// Control characters (C0 with line ends, DEL, C1) become \u001b, which JSON and TOML read back as the same
// character. Bytes that are not UTF-8 become \xff. All else stays as it is.
std::string visible(std::string_view text);

// Leaves out the middle of a long line: a message may repeat what a file has, however much that is.
std::string shortened(const std::string& text);

// Everything that std::cout gets goes to `file` from now on, each line visible. A name that may hold a line
// end is made visible before it is printed.
void show_output_visibly(std::FILE* file);

// Returns the errno of the first failure to write to `file`; 0 if there was none.
int output_failure();

}  // namespace lacuna::tools
