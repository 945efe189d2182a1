// SPDX-License-Identifier: Apache-2.0
#include "tools/console/terminal.hpp"

#include "engine/run/words.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <iostream>
#include <mutex>
#include <streambuf>
#include <utility>

#include <poll.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace lacuna::tools {
namespace {

void append_hexadecimal(std::string& text, unsigned char byte) {
  constexpr char kDigits[] = "0123456789abcdef";
  text += kDigits[byte >> 4];
  text += kDigits[byte & 15];
}

int first_failure = 0;

bool succeeded(bool is_done) {
  if (!is_done && first_failure == 0) first_failure = errno;
  return is_done;
}

// Collects whole lines, so that no character is cut.
class VisibleBuffer final : public std::streambuf {
 public:
  explicit VisibleBuffer(std::FILE* file) : file_(file) {}

 protected:
  int_type overflow(int_type c) override {
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    const char character = traits_type::to_char_type(c);
    return xsputn(&character, 1) == 1 ? c : traits_type::eof();
  }
  std::streamsize xsputn(const char* from, std::streamsize count) override {
    const std::string_view more(from, static_cast<std::size_t>(count));
    const std::size_t line_end = more.rfind('\n');  // in these alone: a line may come in many pieces
    const std::size_t before = text_.size();
    text_ += more;
    if (line_end == std::string_view::npos || text_.size() < kEnough) return count;
    return write(before + line_end + 1) ? count : 0;
  }
  int sync() override { return write(text_.size()) && succeeded(std::fflush(file_) == 0) ? 0 : -1; }

 private:
  static constexpr std::size_t kEnough = std::size_t{1} << 16;

  bool write(std::size_t count) {
    std::string shown;
    std::string_view left = std::string_view(text_).substr(0, count);
    while (!left.empty()) {
      const std::size_t length = std::min(left.find_first_of("\n\t"), left.size());
      shown += visible(left.substr(0, length));
      if (length < left.size()) shown += left[length];
      left.remove_prefix(std::min(length + 1, left.size()));
    }
    text_.erase(0, count);
    return succeeded(std::fwrite(shown.data(), 1, shown.size(), file_) == shown.size());
  }

  std::FILE* file_;
  std::string text_;
};

}  // namespace

std::string visible(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) {
      append_hexadecimal(shown += "\\x", static_cast<unsigned char>(text.front()));
    } else if (is_control(text.substr(0, length))) {
      append_hexadecimal(shown += "\\u00", static_cast<unsigned char>(text[length - 1]));
    } else {
      shown += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return shown;
}

std::string shortened(const std::string& text) {
  constexpr std::size_t kBegin = 600, kEnd = 300;
  if (text.size() <= kBegin + kEnd) return text;
  const auto begin_of_character = [&](std::size_t at) {
    while ((static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) --at;
    return at;
  };
  return text.substr(0, begin_of_character(kBegin)) + " ... " +
         text.substr(begin_of_character(text.size() - kEnd));
}

void show_output_visibly(std::FILE* file) {
  static auto* const buffer =
      new VisibleBuffer(file);  // never destroyed: std::cout is flushed at the very end
  std::cout.rdbuf(buffer);
}

int output_failure() {
  return first_failure;
}

namespace {

using namespace std::chrono_literals;

// A thread that holds the console for longer is writing to a stderr that takes nothing.
constexpr auto kLastLineAfter = 200ms;

// stderr, with at most one line of progress below everything else. The object is never destroyed, since other
// threads may write until the very end.
struct Console {
  static constexpr const char* kErase = "\r\033[K";

  std::string erased() const { return bar.empty() ? "" : kErase; }

  std::timed_mutex mutex;
  std::string bar;
};
Console& console = *new Console;

// Writes neither into a full pipe, nor to a terminal that has been stopped.
bool can_write_now() {
  pollfd err{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
  return poll(&err, 1, 0) == 1;
}

void write_error(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
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
    print_line(line);
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
  print_line(name() + ": error: " + std::string(reason));
}

void print_warnings(std::span<const std::string> warnings) {
  for (const std::string& warning : warnings) spdlog::warn("{}", warning);
}

const std::string& program_name() {
  return name();
}

void print_line(std::string_view line) {
  const std::lock_guard lock(console.mutex);
  write_error(console.erased() + shortened(visible(line)) + '\n' + console.bar);
}

void show_bar(std::string bar) {
  const std::lock_guard lock(console.mutex);
  const std::string before = console.erased();
  console.bar = std::move(bar);
  write_error(before + console.bar);
}

void clear_progress() {
  show_bar("");
}

void clear_progress_now() {
  const std::unique_lock lock(console.mutex, std::try_to_lock);
  if (lock && can_write_now()) write_error(std::exchange(console.bar, "").empty() ? "" : Console::kErase);
}

// Keeps the console. It avoids stdio, whose lock another thread may have.
void print_last_line(std::string_view line) {
  if (!console.mutex.try_lock_for(kLastLineAfter) || !can_write_now()) return;
  const std::string text = console.erased() + shortened(visible(line)) + '\n';
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
}

std::size_t terminal_width() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

namespace {

constexpr int kDigits = 3;
constexpr double kLeastPlain = 1e-3, kMostPlain = 1e15;

std::string print_number(double value) {
  const double size = std::fabs(value);
  if (size != 0 && !(size >= kLeastPlain && size < kMostPlain)) return fmt::format("{:.{}g}", value, kDigits);
  if (size >= 999.5)
    return (value < 0 ? "-" : "") + print_count(static_cast<std::uint64_t>(std::llround(size)));
  // 9.996 has three digits as 10.0.
  int decimals = size > 0 ? kDigits - 1 - static_cast<int>(std::floor(std::log10(size))) : kDigits - 1;
  if (size * std::pow(10, decimals) >= std::pow(10, kDigits) - 0.5) --decimals;
  return fmt::format("{:.{}f}", value, std::max(decimals, 0));
}

std::string with_unit(double value, std::string_view unit, const char* power) {
  std::string text = print_number(value);
  if (!unit.empty()) text.append(" ").append(unit).append(power);
  return text;
}

}  // namespace

std::string counted(std::uint64_t count, std::string_view one, std::string_view several) {
  return print_count(count).append(" ").append(count == 1 ? one : several);
}

std::string print_length(double length, std::string_view unit) {
  return with_unit(length, unit, "");
}

std::string print_area(double area, std::string_view unit) {
  return with_unit(area, unit, "²");
}

std::string print_share(double share) {
  return with_unit(100 * share, "%", "");
}

std::string print_place(const Eigen::Vector3d& place, double extent) {
  constexpr int kMostDecimals = 12;
  const double magnitude = extent > 0 && std::isfinite(extent) ? std::floor(std::log10(extent)) : 0;
  const int decimals = std::clamp(2 - static_cast<int>(magnitude), 0, kMostDecimals);
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    // -0.004 is 0.00, not -0.00.
    const double step = std::pow(10, decimals);
    const double value = std::round(place[axis] * step) / step + 0.0;
    text += (axis > 0 ? " " : "") + fmt::format("{:.{}f}", value, decimals);
  }
  return text;
}

std::string print_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string table;
  for (const auto& row : rows) {
    table += "  " + row[0] + std::string(widths[0] - row[0].size(), ' ');
    for (std::size_t i = 1; i < row.size(); ++i) {
      table += "  " + std::string(widths[i] - row[i].size(), ' ') + row[i];
    }
    table += '\n';
  }
  return table;
}

std::string print_count(std::uint64_t count) {
  std::string text = std::to_string(count);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
  return text;
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
