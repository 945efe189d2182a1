// SPDX-License-Identifier: Apache-2.0
// The output of the program: stderr while it works (progress, the log, errors), and text that is safe to
// show. All that goes to stderr passes through one place, so that a log line never tears the progress bar.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace lacuna::tools {

// Names and messages come from files of others. A control character among them could move the cursor, change
// the title or send keys. So no control character reaches the terminal.

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

// The output of the program on stderr while it works: progress, the log, errors. All of it passes through one
// place, so that a log line never tears the progress bar.

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

// Counts, lengths, areas, places and tables as a person reads them. `unit` is the unit of the scan's
// coordinates, such as "m"; empty if not known.

std::string print_count(std::uint64_t count);  // "1,234,567"
// "1 void", "1,234 voids"
std::string counted(std::uint64_t count, std::string_view one, std::string_view several);

// Prints three digits, without an exponent from 0.001 to a million: "0.0123 m", "2.28 m", "1,234 m".
std::string print_length(double length, std::string_view unit);
std::string print_area(double area, std::string_view unit);  // "3.97 m²"
std::string print_share(double share);                       // "100 %" for 1

// Prints x y z, to a hundredth of the power of ten below `extent`, the size of the scan. So all places of one
// scan have equally many decimals.
std::string print_place(const Eigen::Vector3d& place, double extent);

// Prints rows of equally many cells; there is at least one row. Each column is as wide as its widest cell.
// The first column is aligned to the left, the others to the right.
std::string print_table(const std::vector<std::vector<std::string>>& rows);

std::string print_rate(std::uint64_t points, double seconds);  // "1.25 M points/s"
std::string print_duration(double seconds);                    // "0.42 s", "12.3 s", "3:07 min", "1:02:03 h"

}  // namespace lacuna::tools
