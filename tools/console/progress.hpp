// SPDX-License-Identifier: Apache-2.0
// The progress of a run on stderr, one line for the current step, and how much of the run is done.
#pragma once

#include "engine/config/config.hpp"
#include "engine/run/progress.hpp"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lacuna::tools {

// How much of a run is done, from the step that it is at.

// The names of steps, in the order in which a run begins them.
using RunSteps = std::vector<std::string_view>;

// Returns the steps of a run that finds holes.
RunSteps steps_of_run(const Config& config);
// Returns the steps of a check of an area.
RunSteps steps_of_check();

// Returns the share of the run's time that is over, from 0 to 1, once `step_share` of a step is done. The
// steps before it count as done, whether they took place or not. Each has a weight, so the share is rough.
// It is empty where the run has no such step.
std::optional<double> run_share(const RunSteps& steps, std::string_view step, double step_share);

struct StepProgress {
  std::string step;
  std::uint64_t done = 0, total = 0;  // of the step; total 0: not known
  bool is_done = false;               // the step
  double step_seconds = 0;
  double run_seconds = 0;
  std::optional<double> run_share = {};  // from 0 to 1; rough

  std::optional<double> share() const;             // of the step, from 0 to 1
  std::optional<double> seconds_left() const;      // of the step, at its speed so far
  std::optional<double> run_seconds_left() const;  // from the run's share and time
};

// Counts the progress of a run. Any thread may call any function.
class CountedProgress : public Progress {
 public:
  explicit CountedProgress(RunSteps steps) : steps_(std::move(steps)) {}

  void begin(std::string_view step, std::uint64_t total) override;
  void advance(std::uint64_t count) override { done_.fetch_add(count, std::memory_order_relaxed); }
  void end() noexcept override;
  StepProgress state() const;  // the step is empty before the first one

 private:
  const RunSteps steps_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  mutable std::mutex mutex_;
  std::string step_;
  std::uint64_t total_ = 0;
  bool is_done_ = false;
  std::atomic<std::uint64_t> done_ = 0;
  std::chrono::steady_clock::time_point step_start_;
};

enum class ProgressStyle {
  kBar,    // one line, redrawn
  kPlain,  // for logs: a line at the end of each step, and every 10 seconds in long ones
  kJson,   // for programs: an object at the end of each step, and every second
  kNone,
};

// Chooses a bar if stderr is a terminal, else plain lines.
ProgressStyle default_progress_style();

// Only one may exist at a time. Any thread may advance it.
std::unique_ptr<Progress> make_progress(ProgressStyle style, RunSteps steps);

// "evaluate: 37 %, 1.60 M points/s, 12.3 s left; run: 25 %, 42.0 s, 2:06 min left", without what is not
// known.
std::string progress_text(const StepProgress& progress);
// One line of JSON, with null for what is not known.
std::string progress_json(const StepProgress& progress);
// The text after "lacuna  [===       ]  ", cut to less than `width` columns. The bar is of the run.
std::string progress_bar(const StepProgress& progress, std::size_t width);

}  // namespace lacuna::tools
