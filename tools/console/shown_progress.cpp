// SPDX-License-Identifier: Apache-2.0
#include "tools/console/shown_progress.hpp"

#include "tools/console/terminal.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <utility>

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

std::string percent(double share) {
  return std::to_string(static_cast<int>(std::floor(100 * share))) + " %";
}

std::string time_left(double seconds) {
  if (!(seconds < 359'999)) return "days left";
  const auto whole = static_cast<long long>(std::ceil(seconds));
  const auto two = [](long long value) { return (value < 10 ? "0" : "") + std::to_string(value); };
  if (whole < 3600) return std::to_string(whole / 60) + ":" + two(whole % 60) + " min left";
  return std::to_string(whole / 3600) + ":" + two(whole / 60 % 60) + ":" + two(whole % 60) + " h left";
}

// Counts the progress and shows it now and then, by whichever thread comes by when it is time.
class ShownProgress : public Progress {
 public:
  ShownProgress(std::vector<ExpectedStage> stages, Clock::duration interval)
      : interval_(interval), overall_(std::move(stages)) {}

  void begin(std::string_view stage, std::uint64_t total) final {
    const std::lock_guard lock(mutex_);
    stage_ = stage;
    total_ = total;
    done_ = 0;
    stage_start_ = Clock::now();
    next_ = (stage_start_ + interval_).time_since_epoch().count();
    is_running_ = true;
    overall_.begin(stage, seconds_since(start_));
    show_begin(state());
  }
  void advance(std::uint64_t count) final {
    done_.fetch_add(count, std::memory_order_relaxed);
    const auto now = Clock::now().time_since_epoch().count();
    if (now < next_.load(std::memory_order_relaxed)) return;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || !is_running_ || now < next_) return;
    next_ = now + interval_.count();
    show_now(state());
  }
  void end() noexcept final {
    const std::lock_guard lock(mutex_);
    if (!is_running_) return;
    is_running_ = false;
    const ProgressState before = state();
    overall_.end();
    ProgressState after = before;
    after.overall = overall_.at(before.seconds, 0, 0);
    const std::string line = stage_ + ": done in " + print_duration(before.stage_seconds) +
                             (before.done > 0 ? ", " + print_rate(before.done, before.stage_seconds) : "");
    show_end(after, line);
  }

 protected:
  virtual void show_begin(const ProgressState&) {}
  virtual void show_now(const ProgressState&) {}
  virtual void show_end(const ProgressState&, const std::string& /*line*/) {}

 private:
  ProgressState state() {
    const double seconds = seconds_since(start_);
    const std::uint64_t done = done_;
    return {.stage = stage_,
            .done = done,
            .total = total_,
            .stage_seconds = seconds_since(stage_start_),
            .seconds = seconds,
            .overall = overall_.at(seconds, done, total_)};
  }

  const Clock::duration interval_;
  const Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  OverallProgress overall_;
  std::string stage_;
  std::uint64_t total_ = 0;
  std::atomic<std::uint64_t> done_ = 0;
  Clock::time_point stage_start_;
  std::atomic<Clock::rep> next_ = 0;
  bool is_running_ = false;
};

class BarProgress final : public ShownProgress {
 public:
  explicit BarProgress(std::vector<ExpectedStage> stages) : ShownProgress(std::move(stages), kRedrawAfter) {}
  ~BarProgress() override { clear_progress(); }

 private:
  void show_begin(const ProgressState& state) override { show_now(state); }
  void show_now(const ProgressState& state) override { show_bar(progress_bar(state, terminal_width())); }
  void show_end(const ProgressState&, const std::string&) override { clear_progress(); }
};

class PlainProgress final : public ShownProgress {
 public:
  explicit PlainProgress(std::vector<ExpectedStage> stages)
      : ShownProgress(std::move(stages), kPlainLineAfter) {}

 private:
  void show_now(const ProgressState& state) override {
    std::string line = "lacuna: " + percent(state.overall.share);
    if (state.overall.seconds_left) line += ", " + time_left(*state.overall.seconds_left);
    line += "; " + std::string(state.stage) + ":";
    if (state.total > 0) line += " " + percent(std::min(1.0, double(state.done) / double(state.total))) + ",";
    print_line(line + " " + print_duration(state.stage_seconds) + ", " +
               print_rate(state.done, state.stage_seconds));
  }
  void show_end(const ProgressState& state, const std::string& line) override {
    const double seconds_left = state.overall.seconds_left.value_or(0);
    print_line("lacuna: " + line + (seconds_left >= 1 ? "; " + time_left(seconds_left) : ""));
  }
};

}  // namespace

ProgressStyle default_progress_style() {
  const char* terminal = std::getenv("TERM");
  const bool can_redraw = terminal && std::string_view(terminal) != "dumb";
  return isatty(STDERR_FILENO) && can_redraw ? ProgressStyle::kBar : ProgressStyle::kPlain;
}

std::unique_ptr<Progress> make_progress(ProgressStyle style, std::vector<ExpectedStage> stages) {
  switch (style) {
    case ProgressStyle::kBar:
      return std::make_unique<BarProgress>(std::move(stages));
    case ProgressStyle::kPlain:
      return std::make_unique<PlainProgress>(std::move(stages));
    case ProgressStyle::kNone:
      break;
  }
  return std::make_unique<NoProgress>();
}

std::string progress_bar(const ProgressState& state, std::size_t width) {
  if (width < 2) return "";
  std::string share = percent(state.overall.share);
  share.insert(0, share.size() < 5 ? 5 - share.size() : 0, ' ');
  const std::string before = "lacuna " + share;
  std::string after = "  " + std::string(state.stage.substr(0, 24));
  after.resize(std::max<std::size_t>(after.size(), 12), ' ');
  std::string rate = state.done > 0 ? print_rate(state.done, state.stage_seconds) : "";
  rate.resize(std::max<std::size_t>(rate.size(), 15), ' ');  // so that the bar does not jump
  after += "  " + rate;
  if (state.overall.seconds_left) after += "  " + time_left(*state.overall.seconds_left);

  constexpr std::size_t kLeastBar = 8, kLargestBar = 40;
  const std::size_t room = width - 1;  // the cursor stays on the line
  const std::size_t taken = before.size() + after.size() + 4;
  std::string bar;
  if (taken + kLeastBar <= room) {
    const std::size_t length = std::min(kLargestBar, room - taken);
    const auto filled = static_cast<std::size_t>(state.overall.share * double(length));
    bar = "  [" + std::string(filled, '=') + std::string(length - filled, ' ') + "]";
  }
  return (before + bar + after).substr(0, room);
}

}  // namespace lacuna::tools
