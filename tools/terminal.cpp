#include "tools/terminal.hpp"

#include "tools/visible_text.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <utility>

#include <poll.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace lacuna {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kRedrawAfter = 100ms;
constexpr auto kPlainLineAfter = 10s;
constexpr auto kLastLineAfter =
    200ms;  // who has the console for longer writes to a stderr that takes nothing

// stderr, with at most one line of progress that stands below everything else.
class Console {
 public:
  void print_line(std::string_view line) {
    const std::lock_guard lock(mutex_);
    write(erased() + visible(line) + '\n' + bar_);
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
  // Keeps the console. Without stdio, whose lock another thread may have.
  void print_last_line(std::string_view line) {
    if (!mutex_.try_lock_for(kLastLineAfter) || !can_write_now()) return;
    const std::string text = erased() + visible(line) + '\n';
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
  }

 private:
  static constexpr const char* kErase = "\r\033[K";

  std::string erased() const { return bar_.empty() ? "" : kErase; }
  // Not into a full pipe, nor to a terminal that has been stopped.
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

// Never destroyed: other threads may write until the very end.
Console& console() {
  static Console* const instance = new Console;
  return *instance;
}

class ConsoleSink final : public spdlog::sinks::base_sink<std::mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    std::string line = "lacuna: ";
    if (message.level >= spdlog::level::warn) {
      const auto level = spdlog::level::to_string_view(message.level);
      line.append(level.data(), level.size()).append(": ");
    }
    line.append(message.payload.data(), message.payload.size());
    console().print_line(line);
  }
  void flush_() override {}
};

std::size_t terminal_width() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

// Counts what passes and shows it now and then, by whichever thread comes by when it is time.
class ShownProgress : public Progress {
 public:
  explicit ShownProgress(Clock::duration interval) : interval_(interval) {}

  void begin(std::string_view phase, std::uint64_t total) final {
    const std::lock_guard lock(mutex_);
    phase_ = phase;
    total_ = total;
    done_ = 0;
    start_ = Clock::now();
    next_ = (start_ + interval_).time_since_epoch().count();
    is_running_ = true;
    show_begin();
  }
  void advance(std::uint64_t count) final {
    done_.fetch_add(count, std::memory_order_relaxed);
    const auto now = Clock::now().time_since_epoch().count();
    if (now < next_.load(std::memory_order_relaxed)) return;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || !is_running_ || now < next_) return;
    next_ = now + interval_.count();
    show_now();
  }
  void end() final {
    const std::lock_guard lock(mutex_);
    if (!is_running_) return;
    is_running_ = false;
    show_end();
  }

 protected:
  virtual void show_begin() = 0;
  virtual void show_now() = 0;
  virtual void show_end() = 0;

  const std::string& phase() const { return phase_; }
  std::uint64_t done() const { return done_; }
  std::uint64_t total() const { return total_; }
  double seconds() const { return seconds_since(start_); }

 private:
  const Clock::duration interval_;
  std::mutex mutex_;
  std::string phase_;
  std::uint64_t total_ = 0;
  std::atomic<std::uint64_t> done_ = 0;
  Clock::time_point start_;
  std::atomic<Clock::rep> next_ = 0;
  bool is_running_ = false;
};

class BarProgress final : public ShownProgress {
 public:
  BarProgress() : ShownProgress(kRedrawAfter) {}
  ~BarProgress() override { clear_progress(); }

 private:
  void show_begin() override { show_now(); }
  void show_now() override {
    console().show_bar(progress_bar(phase(), done(), total(), seconds(), terminal_width()));
  }
  void show_end() override { clear_progress(); }
};

class PlainProgress final : public ShownProgress {
 public:
  PlainProgress() : ShownProgress(kPlainLineAfter) {}

 private:
  void show_begin() override {}
  void show_now() override {
    std::string share;
    if (total() > 0) share = formatted(" %.0f %%,", 100.0 * std::min(1.0, double(done()) / double(total())));
    console().print_line("lacuna: " + phase() + ":" + share + " " + print_duration(seconds()) + ", " +
                         print_rate(done(), seconds()));
  }
  void show_end() override {
    const std::string rate = done() > 0 ? ", " + print_rate(done(), seconds()) : "";
    console().print_line("lacuna: " + phase() + ": done in " + print_duration(seconds()) + rate);
  }
};

}  // namespace

ProgressStyle default_progress_style() {
  const char* terminal = std::getenv("TERM");
  const bool can_redraw = terminal && std::string_view(terminal) != "dumb";
  return isatty(STDERR_FILENO) && can_redraw ? ProgressStyle::kBar : ProgressStyle::kPlain;
}

std::unique_ptr<Progress> make_progress(ProgressStyle style) {
  if (style == ProgressStyle::kBar) return std::make_unique<BarProgress>();
  if (style == ProgressStyle::kPlain) return std::make_unique<PlainProgress>();
  return std::make_unique<NoProgress>();
}

void start_log() {
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("lacuna", std::make_shared<ConsoleSink>()));
}

void quiet_log() {
  spdlog::set_level(spdlog::level::warn);
}

void print_error(std::string_view reason) {
  clear_progress();
  console().print_line("lacuna: error: " + std::string(reason));
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

std::string progress_bar(std::string_view phase, std::uint64_t done, std::uint64_t total, double seconds,
                         std::size_t width) {
  if (width < 2) return "";
  std::string before(phase.substr(0, 24));
  before.resize(std::max<std::size_t>(before.size(), 10), ' ');
  std::string after;
  const double share = total > 0 ? std::min(1.0, double(done) / double(total)) : 0;
  if (total > 0) after += formatted(" %3.0f %%", std::floor(100 * share));
  if (done > 0) after += "  " + print_rate(done, seconds);
  if (done > 0 && total > done) after += "  " + print_duration(seconds * (1 / share - 1)) + " left";

  constexpr std::size_t kLeastBar = 8, kLargestBar = 40;
  const std::size_t room = width - 1;  // the cursor stays on the line
  const std::size_t taken = before.size() + after.size() + 3;
  std::string bar;
  if (total > 0 && taken + kLeastBar <= room) {
    const std::size_t length = std::min(kLargestBar, room - taken);
    const auto filled = static_cast<std::size_t>(share * double(length));
    bar = " [" + std::string(filled, '=') + std::string(length - filled, ' ') + "]";
  }
  return (before + bar + after).substr(0, room);
}

std::string print_rate(std::uint64_t points, double seconds) {
  const double millions = double(points) / std::max(seconds, 1e-9) / 1e6;
  return formatted(millions < 10 ? "%.2f M points/s" : "%.0f M points/s", millions);
}

std::string print_duration(double seconds) {
  if (!(seconds < 1e9)) return "a long time";
  if (seconds < 9.995) return formatted("%.2f s", seconds);
  if (seconds < 59.95) return formatted("%.1f s", seconds);
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 3600) return formatted("%lld:%02lld min", whole / 60, whole % 60);
  return formatted("%lld:%02lld:%02lld h", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace lacuna
