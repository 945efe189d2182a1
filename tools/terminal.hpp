// What the program shows on stderr while it works: progress, the log, errors. All of it passes through one
// place, so that a log line never tears the progress bar.
#pragma once

#include "engine/run/progress.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace lacuna {

enum class ProgressStyle {
  kBar,    // one line, redrawn
  kPlain,  // a line at the end of each phase, and every 10 seconds in long ones
  kNone,
};

// A bar where stderr is a terminal, else plain lines.
ProgressStyle default_progress_style();

// One at a time. May be advanced from any thread.
std::unique_ptr<Progress> make_progress(ProgressStyle style);

// spdlog's default logger writes to stderr from now on: "lacuna: ...", "lacuna: warning: ...".
void start_log();
void quiet_log();  // warnings and errors only

void print_error(std::string_view reason);  // "lacuna: error: ..."
void clear_progress();
// The last that the program prints, if stderr takes it at once: nothing gets to the console afterwards.
void print_last_line(std::string_view line);
void clear_progress_now();  // does not wait: leaves it where stderr takes nothing at the moment

// The phase so far, for a terminal of `width` columns; shorter than that, whatever the width.
std::string progress_bar(std::string_view phase, std::uint64_t done, std::uint64_t total, double seconds,
                         std::size_t width);

std::string print_rate(std::uint64_t points, double seconds);  // "1.25 M points/s"
std::string print_duration(double seconds);                    // "0.42 s", "12.3 s", "3:07 min", "1:02:03 h"

}  // namespace lacuna
