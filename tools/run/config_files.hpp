// SPDX-License-Identifier: Apache-2.0
// Finds configs by the name that they are installed with.
#pragma once

#include <filesystem>
#include <string>

namespace lacuna::tools {

// Returns `given` itself if it names an existing file, or has a slash or the ending .toml. Else returns
// NAME.toml from the first of two folders that has it. The first is share/lacuna/configs of the prefix that
// the program is installed in. The second is the source's configs, for a program in a build folder within.
// Throws `Error`, which lists the names that exist, if neither folder has the file.
std::filesystem::path find_config(const std::string& given);

}  // namespace lacuna::tools
