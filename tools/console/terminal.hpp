// SPDX-License-Identifier: Apache-2.0
// The output of the program on stderr while it works: progress, the log, errors. All of it passes through one
// place, so that a log line never tears the progress bar.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace lacuna::tools {

// spdlog's default logger writes to stderr from now on: "PROGRAM: ...", "PROGRAM: warning: ...".
void start_log(const std::string& program);
const std::string& program_name();  // "lacuna" before start_log
void quiet_log();                   // warnings and errors only

void print_error(std::string_view reason);                   // "PROGRAM: error: ..."
void print_warnings(std::span<const std::string> warnings);  // by the log, a line each
void print_line(std::string_view line);                      // above the line of progress
void show_bar(std::string bar);                              // in place of the one before
void clear_progress();
// The last line that the program prints, if stderr takes it at once: nothing gets to the console afterwards.
void print_last_line(std::string_view line);
void clear_progress_now();  // does not wait: leaves it where stderr takes nothing at the moment

std::size_t terminal_width();  // columns; 80 where stderr is no terminal

std::string print_rate(std::uint64_t points, double seconds);  // "1.25 M points/s"
std::string print_duration(double seconds);                    // "0.42 s", "12.3 s", "3:07 min", "1:02:03 h"

}  // namespace lacuna::tools
