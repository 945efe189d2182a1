// SPDX-License-Identifier: Apache-2.0
// The progress of a run on stderr.
#pragma once

#include "engine/run/progress.hpp"
#include "tools/console/overall_progress.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::tools {

enum class ProgressStyle {
  kBar,    // one line, redrawn
  kPlain,  // for logs: a line at the end of each stage, and every 10 seconds in long ones
  kNone,
};

// Chooses a bar if stderr is a terminal, else plain lines.
ProgressStyle default_progress_style();

// Only one may exist at a time. Any thread may advance it.
std::unique_ptr<Progress> make_progress(ProgressStyle style, std::vector<ExpectedStage> stages);

struct ProgressState {
  std::string_view stage;
  std::uint64_t done = 0, total = 0;  // of the stage; total 0: not known
  double stage_seconds = 0;
  double seconds = 0;  // since the run began
  OverallProgress::State overall;
};

// "lacuna  37 %  [=====      ]  evaluate  1.60 M points/s  0:42 min left", for a terminal of `width` columns;
// shorter than that, whatever the width.
std::string progress_bar(const ProgressState& state, std::size_t width);

}  // namespace lacuna::tools
