// SPDX-License-Identifier: Apache-2.0
// Checks that a file may be opened and read.
#pragma once

#include <filesystem>
#include <string_view>

namespace lacuna {

// Throws `Error` unless `file` is a regular file. Must come before the file is opened: to open a named pipe
// waits for a writer, and a device may have no end. `needed` is for the error: "a scan file".
void check_regular_file(const std::filesystem::path& file, std::string_view needed);

}  // namespace lacuna
