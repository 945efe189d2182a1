// SPDX-License-Identifier: Apache-2.0
// The progress of a run on stderr, one line for the current step.
#pragma once

#include "engine/run/progress.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace lacuna::tools {

struct StepProgress {
  std::string step;
  std::uint64_t done = 0, total = 0;  // of the step; total 0: not known
  double step_seconds = 0;
  double run_seconds = 0;

  std::optional<double> share() const;         // of the step, from 0 to 1
  std::optional<double> seconds_left() const;  // of the step, at its speed so far
};

enum class ProgressStyle {
  kBar,    // one line, redrawn
  kPlain,  // for logs: a line at the end of each step, and every 10 seconds in long ones
  kNone,
};

// Chooses a bar if stderr is a terminal, else plain lines.
ProgressStyle default_progress_style();

// Only one may exist at a time. Any thread may advance it.
std::unique_ptr<Progress> make_progress(ProgressStyle style);

// "evaluate: 37 %, 1.60 M points/s, 12.3 s left; run: 42.0 s", without what is not known.
std::string progress_text(const StepProgress& progress);
// The same after "lacuna  [===       ]  ", cut to less than `width` columns.
std::string progress_bar(const StepProgress& progress, std::size_t width);

}  // namespace lacuna::tools
