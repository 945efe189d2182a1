// SPDX-License-Identifier: Apache-2.0
// Estimates the progress of a run over all of its stages, and the time left.
#pragma once

#include "engine/config/config.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::tools {

struct ExpectedStage {
  std::string name;
  double weight = 0;  // its typical time, in units common to all
};

// The stages of a run in their order, as the config determines them.
std::vector<ExpectedStage> expected_stages(const Config& config);

// Follows a run by typical times of its stages. The class has no clock: `seconds` count from the run's begin.
class OverallProgress {
 public:
  struct State {
    double share = 0;                    // from 0 to 1, never less than before
    std::optional<double> seconds_left;  // 0 or more; empty at the very beginning
  };

  explicit OverallProgress(std::vector<ExpectedStage> stages) : ahead_(std::move(stages)) {}

  // Stages that were expected before this one do not take place. One that was not expected takes part with
  // its typical weight.
  void begin(std::string_view stage, double seconds);
  void end();

  // Takes `done` of `total` of the current stage. If the total is 0, it is not known, and the stage's time
  // counts.
  State at(double seconds, std::uint64_t done, std::uint64_t total);

 private:
  double share_of_stage(double seconds, std::uint64_t done, std::uint64_t total) const;

  std::vector<ExpectedStage> ahead_;
  double behind_ = 0;   // weight of the stages that have ended
  double current_ = 0;  // weight of the current one; 0 before the first
  double begin_ = 0;    // of the current one
  double shown_ = 0;    // the largest share so far
};

}  // namespace lacuna::tools
