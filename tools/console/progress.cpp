// SPDX-License-Identifier: Apache-2.0
#include "tools/console/progress.hpp"

#include "engine/thin/thin.hpp"
#include "tools/console/terminal.hpp"

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <stop_token>
#include <thread>

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

namespace lacuna::tools {
namespace {

struct StepWeight {
  std::string_view step;
  double weight;
};

// In the order of a run, and then of a check. Weights are per cent of its time: means of a terrestrial scan
// of 1.0 M points and of an object of 0.8 M. Those of `thin`, `orient`, `area` and `voids` are from runs that
// have these steps.
constexpr StepWeight kWeights[] = {
    {"survey", 4}, {"bucket", 3},  {"order", 3},   {"thin", 4},    {"halo", 3}, {"evaluate", 29},
    {"loops", 17}, {"levels", 30}, {"track", 1},   {"measure", 0}, {"nest", 0}, {"coherence", 0},
    {"sample", 4}, {"orient", 4},  {"collect", 1}, {"write", 5},   {"area", 4}, {"voids", 1}};

double weight_of(std::string_view step) {
  const auto found = std::ranges::find(kWeights, step, &StepWeight::step);
  return found == std::end(kWeights) ? 0 : found->weight;
}

}  // namespace

RunSteps steps_of_run(const Config& config) {
  RunSteps steps;
  for (const StepWeight& weight : kWeights) steps.push_back(weight.step);
  std::erase_if(steps, [&](std::string_view step) {
    if (step == "thin") return first_edge(config.scale) == 0;
    if (step == "levels" || step == "track") return !has_levels(config);
    if (step == "orient") return !config.normals.orient;
    return step == "area" || step == "voids";  // of a check
  });
  return steps;
}

RunSteps steps_of_check() {
  return {"area", "voids"};
}

std::optional<double> run_share(const RunSteps& steps, std::string_view step, double step_share) {
  double before = 0, all = 0;
  bool is_there = false;
  for (const std::string_view other : steps) {
    const double weight = weight_of(other);
    is_there = is_there || other == step;
    if (!is_there) before += weight;
    all += weight;
  }
  if (!is_there) return std::nullopt;
  return (before + weight_of(step) * step_share) / all;
}

namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kLookAfter = 100ms;

Clock::duration interval_of(ProgressStyle style) {
  if (style == ProgressStyle::kPlain) return 10s;
  return style == ProgressStyle::kJson ? Clock::duration(1s) : kLookAfter;
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string rate_of(const StepProgress& progress) {
  return progress.done > 0 ? ", " + print_rate(progress.done, progress.step_seconds) : "";
}

std::string per_cent(double share) {
  return std::to_string(static_cast<int>(100 * share)) + " %";
}

std::string run_time(const StepProgress& progress) {
  std::string text = "; run: ";
  if (progress.run_share) text += per_cent(*progress.run_share) + ", ";
  text += print_duration(progress.run_seconds);
  if (const auto left = progress.run_seconds_left()) text += ", " + print_duration(*left) + " left";
  return text;
}

std::string json_number(const std::optional<double>& value) {
  return value ? fmt::format("{:.3f}", *value) : "null";
}

std::optional<double> seconds_left_of(std::optional<double> share, double seconds) {
  if (share.value_or(0) == 0) return std::nullopt;
  return seconds * (1 - *share) / *share;
}

// Shows the progress now and then, by a thread of its own: some steps count no points.
class ShownProgress final : public CountedProgress {
 public:
  ShownProgress(ProgressStyle style, RunSteps steps)
      : CountedProgress(std::move(steps)),
        style_(style),
        clock_([this](const std::stop_token& stop) { show_until(stop); }) {}
  ~ShownProgress() override {
    clock_.request_stop();
    clock_.join();
    clear_progress();
  }

  void begin(std::string_view step, std::uint64_t total) override {
    const std::lock_guard lock(mutex_);
    CountedProgress::begin(step, total);
    is_running_ = true;
    next_ = Clock::now() + interval_of(style_);
    if (style_ == ProgressStyle::kBar) show();
  }
  void end() noexcept override {
    const std::lock_guard lock(mutex_);
    if (!is_running_) return;
    is_running_ = false;
    CountedProgress::end();
    if (style_ == ProgressStyle::kBar) return clear_progress();
    if (style_ == ProgressStyle::kJson) return show();
    const StepProgress all = state();
    print_line("lacuna: " + all.step + ": done in " + print_duration(all.step_seconds) + rate_of(all) +
               run_time(all));
  }
  void make_again(std::string_view step) override {
    const std::lock_guard lock(mutex_);
    if (!std::exchange(is_made_again_, true))
      print_line("lacuna: " + std::string(step) + " is made again, and what follows from it");
  }

 private:
  void show_until(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
      woken_.wait_for(lock, stop, kLookAfter, [] { return false; });
      if (is_running_ && !stop.stop_requested() && Clock::now() >= next_) show();
    }
  }
  void show() {
    next_ = Clock::now() + interval_of(style_);
    if (style_ == ProgressStyle::kBar) return show_bar(progress_bar(state(), terminal_width()));
    print_line(style_ == ProgressStyle::kJson ? progress_json(state()) : "lacuna: " + progress_text(state()));
  }

  const ProgressStyle style_;
  std::mutex mutex_;
  std::condition_variable_any woken_;
  Clock::time_point next_;
  bool is_running_ = false, is_made_again_ = false;
  std::jthread clock_;  // uses the others
};

}  // namespace

void CountedProgress::begin(std::string_view step, std::uint64_t total) {
  const std::lock_guard lock(mutex_);
  step_ = step;
  total_ = total;
  done_ = 0;
  is_done_ = false;
  step_start_ = Clock::now();
}

void CountedProgress::end() noexcept {
  const std::lock_guard lock(mutex_);
  is_done_ = true;
}

StepProgress CountedProgress::state() const {
  const std::lock_guard lock(mutex_);
  StepProgress state{.step = step_, .done = done_, .total = total_, .is_done = is_done_};
  if (step_.empty()) return state;
  state.step_seconds = seconds_since(step_start_);
  state.run_seconds = seconds_since(start_);
  state.run_share = run_share(steps_, step_, state.share().value_or(0));
  return state;
}

std::optional<double> StepProgress::share() const {
  if (is_done) return 1;
  if (total == 0) return std::nullopt;
  return std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
}

std::optional<double> StepProgress::seconds_left() const {
  return seconds_left_of(share(), step_seconds);
}

std::optional<double> StepProgress::run_seconds_left() const {
  return seconds_left_of(run_share, run_seconds);
}

ProgressStyle default_progress_style() {
  const char* terminal = std::getenv("TERM");
  const bool can_redraw = terminal && std::string_view(terminal) != "dumb";
  return isatty(STDERR_FILENO) && can_redraw ? ProgressStyle::kBar : ProgressStyle::kPlain;
}

std::unique_ptr<Progress> make_progress(ProgressStyle style, RunSteps steps) {
  if (style == ProgressStyle::kNone) return std::make_unique<NoProgress>();
  return std::make_unique<ShownProgress>(style, std::move(steps));
}

std::string progress_text(const StepProgress& progress) {
  std::string known;
  if (const auto share = progress.share()) known += ", " + per_cent(*share);
  known += rate_of(progress);
  if (const auto left = progress.seconds_left()) known += ", " + print_duration(*left) + " left";
  return progress.step + (known.empty() ? "" : ":" + known.substr(1)) + run_time(progress);
}

std::string progress_json(const StepProgress& progress) {
  return "{\"step\": \"" + progress.step + "\", \"share\": " + json_number(progress.share()) +
         ", \"seconds\": " + json_number(progress.step_seconds) +
         ", \"seconds_left\": " + json_number(progress.seconds_left()) +
         ", \"points\": " + std::to_string(progress.done) +
         ", \"run_share\": " + json_number(progress.run_share) +
         ", \"run_seconds\": " + json_number(progress.run_seconds) +
         ", \"run_seconds_left\": " + json_number(progress.run_seconds_left()) + "}";
}

std::string progress_bar(const StepProgress& progress, std::size_t width) {
  constexpr std::size_t kLength = 10;
  const double share = progress.run_share.value_or(progress.share().value_or(0));
  const auto filled = static_cast<std::size_t>(share * kLength);
  const std::string bar = std::string(filled, '=') + std::string(kLength - filled, ' ');
  // The cursor stays on the line.
  return ("lacuna  [" + bar + "]  " + progress_text(progress)).substr(0, std::max<std::size_t>(width, 1) - 1);
}

}  // namespace lacuna::tools
