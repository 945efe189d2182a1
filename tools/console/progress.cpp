// SPDX-License-Identifier: Apache-2.0
#include "tools/console/progress.hpp"

#include "tools/console/terminal.hpp"
#include "tools/console/visible_text.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <string_view>

#include <unistd.h>

namespace lacuna::tools {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kRedrawAfter = 100ms;
constexpr auto kPlainLineAfter = 10s;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string rate_of(const StepProgress& progress) {
  return progress.done > 0 ? ", " + print_rate(progress.done, progress.step_seconds) : "";
}

std::string run_time(const StepProgress& progress) {
  return "; run: " + print_duration(progress.run_seconds);
}

// Counts the progress and shows it now and then, by whichever thread comes by when it is time.
class ShownProgress final : public Progress {
 public:
  explicit ShownProgress(bool is_bar)
      : is_bar_(is_bar), interval_(is_bar ? Clock::duration(kRedrawAfter) : kPlainLineAfter) {}
  ~ShownProgress() override { clear_progress(); }

  void begin(std::string_view step, std::uint64_t total) override {
    const std::lock_guard lock(mutex_);
    step_ = step;
    total_ = total;
    done_ = 0;
    step_start_ = Clock::now();
    next_ = (step_start_ + interval_).time_since_epoch().count();
    is_running_ = true;
    if (is_bar_) show();
  }
  void advance(std::uint64_t count) override {
    done_.fetch_add(count, std::memory_order_relaxed);
    const auto now = Clock::now().time_since_epoch().count();
    if (now < next_.load(std::memory_order_relaxed)) return;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || !is_running_ || now < next_) return;
    next_ = now + interval_.count();
    show();
  }
  void end() noexcept override {
    const std::lock_guard lock(mutex_);
    if (!is_running_) return;
    is_running_ = false;
    if (is_bar_) return clear_progress();
    const StepProgress all = state();
    print_line("lacuna: " + all.step + ": done in " + print_duration(all.step_seconds) + rate_of(all) +
               run_time(all));
  }
  void make_again(std::string_view step, std::string_view why) override {
    const std::lock_guard lock(mutex_);
    print_line("lacuna: " + std::string(step) + " is made again: " + visible(std::string(why)));
  }

 private:
  StepProgress state() const {
    return {.step = step_,
            .done = done_,
            .total = total_,
            .step_seconds = seconds_since(step_start_),
            .run_seconds = seconds_since(start_)};
  }
  void show() const {
    if (is_bar_) {
      show_bar(progress_bar(state(), terminal_width()));
    } else {
      print_line("lacuna: " + progress_text(state()));
    }
  }

  const bool is_bar_;
  const Clock::duration interval_;
  const Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::string step_;
  std::uint64_t total_ = 0;
  std::atomic<std::uint64_t> done_ = 0;
  Clock::time_point step_start_;
  std::atomic<Clock::rep> next_ = 0;
  bool is_running_ = false;
};

}  // namespace

std::optional<double> StepProgress::share() const {
  if (total == 0) return std::nullopt;
  return std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
}

std::optional<double> StepProgress::seconds_left() const {
  const double part = share().value_or(0);
  if (part == 0) return std::nullopt;
  return step_seconds * (1 - part) / part;
}

ProgressStyle default_progress_style() {
  const char* terminal = std::getenv("TERM");
  const bool can_redraw = terminal && std::string_view(terminal) != "dumb";
  return isatty(STDERR_FILENO) && can_redraw ? ProgressStyle::kBar : ProgressStyle::kPlain;
}

std::unique_ptr<Progress> make_progress(ProgressStyle style) {
  if (style == ProgressStyle::kNone) return std::make_unique<NoProgress>();
  return std::make_unique<ShownProgress>(style == ProgressStyle::kBar);
}

std::string progress_text(const StepProgress& progress) {
  std::string known;
  if (const auto share = progress.share())
    known += ", " + std::to_string(static_cast<int>(100 * *share)) + " %";
  known += rate_of(progress);
  if (const auto left = progress.seconds_left()) known += ", " + print_duration(*left) + " left";
  return progress.step + (known.empty() ? "" : ":" + known.substr(1)) + run_time(progress);
}

std::string progress_bar(const StepProgress& progress, std::size_t width) {
  constexpr std::size_t kLength = 10;
  const auto filled = static_cast<std::size_t>(progress.share().value_or(0) * kLength);
  const std::string bar = std::string(filled, '=') + std::string(kLength - filled, ' ');
  // The cursor stays on the line.
  return ("lacuna  [" + bar + "]  " + progress_text(progress)).substr(0, std::max<std::size_t>(width, 1) - 1);
}

}  // namespace lacuna::tools
