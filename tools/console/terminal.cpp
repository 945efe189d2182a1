// SPDX-License-Identifier: Apache-2.0
#include "tools/console/terminal.hpp"

#include "tools/console/visible_text.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <utility>

#include <poll.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace lacuna::tools {
namespace {

using namespace std::chrono_literals;

// A thread that holds the console for longer is writing to a stderr that takes nothing.
constexpr auto kLastLineAfter = 200ms;

// stderr, with at most one line of progress below everything else.
class Console {
 public:
  void print_line(std::string_view line) {
    const std::lock_guard lock(mutex_);
    write(erased() + shortened(visible(line)) + '\n' + bar_);
  }
  void show_bar(std::string bar) {
    const std::lock_guard lock(mutex_);
    const std::string before = erased();
    bar_ = std::move(bar);
    write(before + bar_);
  }
  void clear_now() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (lock && can_write_now()) write(std::exchange(bar_, "").empty() ? "" : kErase);
  }
  // Keeps the console. It avoids stdio, whose lock another thread may have.
  void print_last_line(std::string_view line) {
    if (!mutex_.try_lock_for(kLastLineAfter) || !can_write_now()) return;
    const std::string text = erased() + shortened(visible(line)) + '\n';
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
  }

 private:
  static constexpr const char* kErase = "\r\033[K";

  std::string erased() const { return bar_.empty() ? "" : kErase; }
  // Writes neither into a full pipe, nor to a terminal that has been stopped.
  static bool can_write_now() {
    pollfd err{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
    return poll(&err, 1, 0) == 1;
  }
  static void write(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
  }

  std::timed_mutex mutex_;
  std::string bar_;
};

// The object is never destroyed, since other threads may write until the very end.
Console& console() {
  static Console* const instance = new Console;
  return *instance;
}

// The program's name comes before each line.
std::string& name() {
  static std::string* const instance = new std::string("lacuna");
  return *instance;
}

class ConsoleSink final : public spdlog::sinks::base_sink<std::mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    std::string line = name() + ": ";
    if (message.level >= spdlog::level::warn) {
      const auto level = spdlog::level::to_string_view(message.level);
      line.append(level.data(), level.size()).append(": ");
    }
    line.append(message.payload.data(), message.payload.size());
    console().print_line(line);
  }
  void flush_() override {}
};

}  // namespace

void start_log(const std::string& program) {
  name() = program;
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(program, std::make_shared<ConsoleSink>()));
}

void quiet_log() {
  spdlog::set_level(spdlog::level::warn);
}

void print_error(std::string_view reason) {
  clear_progress();
  console().print_line(name() + ": error: " + std::string(reason));
}

void print_warnings(std::span<const std::string> warnings) {
  for (const std::string& warning : warnings) spdlog::warn("{}", warning);
}

const std::string& program_name() {
  return name();
}

void print_line(std::string_view line) {
  console().print_line(line);
}

void show_bar(std::string bar) {
  console().show_bar(std::move(bar));
}

void clear_progress() {
  console().show_bar("");
}

void print_last_line(std::string_view line) {
  console().print_last_line(line);
}

void clear_progress_now() {
  console().clear_now();
}

std::size_t terminal_width() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

std::string print_rate(std::uint64_t points, double seconds) {
  const double millions = double(points) / std::max(seconds, 1e-9) / 1e6;
  return fmt::format("{:.{}f} M points/s", millions, millions < 10 ? 2 : 0);
}

std::string print_duration(double seconds) {
  if (!(seconds < 1e9)) return "a long time";
  if (seconds < 9.995) return fmt::format("{:.2f} s", seconds);
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02} h", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace lacuna::tools
