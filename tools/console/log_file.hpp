// SPDX-License-Identifier: Apache-2.0
// The log of runs in a file, for --log-file. It has what the log on stderr says, the times of stages and
// errors, each line with its time. Runs are appended.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lacuna::tools {

// What the first line of a run's log says: the version and the words of the command line.
void remember_command_line(std::string_view version, int argc, char** argv);

// From now on spdlog's default logger writes to `file`, too: everything from info on, however quiet stderr
// is. Throws `Error` if the file cannot be written to, or holds anything but such a log.
void start_log_file(const std::filesystem::path& file);

// For the file alone; without one nothing happens. From any thread.
void log_to_file(std::string_view line);
void log_error_to_file(std::string_view reason);

}  // namespace lacuna::tools
