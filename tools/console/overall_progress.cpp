// SPDX-License-Identifier: Apache-2.0
#include "tools/console/overall_progress.hpp"

#include "engine/thin/thin.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace lacuna::tools {
namespace {

struct TypicalTime {
  std::string_view stage;
  double weight;
};

// Times of stages, of which 100 are about the time of a default run without `levels`. Measured on scans of
// 0.8 to 3 million points (dragon_30scans, balm_23scans, a synthetic plane) with 2 threads.
constexpr std::array<TypicalTime, 15> kTypicalTimes{{{"survey", 3},
                                                     {"bucket", 11},
                                                     {"thin", 30},
                                                     {"halo", 6},
                                                     {"evaluate", 64},
                                                     {"loops", 8},
                                                     {"levels", 90},
                                                     {"track", 4},
                                                     {"coherence", 0.5},
                                                     {"measure", 0.5},
                                                     {"nest", 0.5},
                                                     {"sample", 4},
                                                     {"orient", 15},
                                                     {"collect", 0.5},
                                                     {"write", 3}}};
constexpr double kWritePoints = 10;  // the annotated scan
constexpr double kUnknownStage = 3;
constexpr double kLeastShare = 0.01;  // below, the time left is a guess

double typical_time(std::string_view stage) {
  const auto found = std::find_if(kTypicalTimes.begin(), kTypicalTimes.end(),
                                  [stage](const TypicalTime& typical) { return typical.stage == stage; });
  return found != kTypicalTimes.end() ? found->weight : kUnknownStage;
}

}  // namespace

std::vector<ExpectedStage> expected_stages(const Config& config) {
  std::vector<ExpectedStage> stages;
  const auto add = [&stages](std::string_view name, double more = 0) {
    stages.push_back({std::string(name), typical_time(name) + more});
  };
  for (const char* name : {"survey", "bucket"}) add(name);
  if (first_edge(config.scale) > 0) add("thin");
  for (const char* name : {"halo", "evaluate", "loops"}) add(name);
  if (has_levels(config)) add("levels");
  if (config.loops.method == LoopMethod::kTangential) add("track");
  for (const char* name : {"measure", "nest", "coherence"}) add(name);
  if (config.results.sample_points > 0) add("sample");
  if (config.normals.orient) add("orient");
  add("collect");
  add("write", config.results.points ? kWritePoints : 0);
  return stages;
}

void OverallProgress::begin(std::string_view stage, double seconds) {
  end();
  begin_ = seconds;
  const auto found = std::find_if(ahead_.begin(), ahead_.end(),
                                  [stage](const ExpectedStage& expected) { return expected.name == stage; });
  if (found == ahead_.end()) {
    current_ = typical_time(stage);
    return;
  }
  current_ = found->weight;
  ahead_.erase(ahead_.begin(), found + 1);
}

void OverallProgress::end() {
  behind_ += std::exchange(current_, 0);
}

// For a stage without a total, the stages before it give its expected time: its weight at their pace. After
// this time, the share is one half. The first stage has one second. If the stages before took no time at all,
// nothing is expected, and the share is 1 at once.
double OverallProgress::share_of_stage(double seconds, std::uint64_t done, std::uint64_t total) const {
  if (total > 0) return std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  const double spent = std::max(seconds - begin_, 0.0);
  const double expected = behind_ > 0 ? begin_ / behind_ * current_ : 1;
  return spent + expected > 0 ? spent / (spent + expected) : 0;
}

OverallProgress::State OverallProgress::at(double seconds, std::uint64_t done, std::uint64_t total) {
  const double ahead =
      std::accumulate(ahead_.begin(), ahead_.end(), 0.0,
                      [](double sum, const ExpectedStage& stage) { return sum + stage.weight; });
  const double spent = behind_ + (current_ > 0 ? current_ * share_of_stage(seconds, done, total) : 0);
  const double all = behind_ + current_ + ahead;
  const double share = all > 0 ? std::clamp(spent / all, 0.0, 1.0) : 0;
  shown_ = std::max(shown_, share);
  State state{.share = shown_};
  if (share >= kLeastShare) state.seconds_left = std::max(seconds, 0.0) * (1 - share) / share;
  return state;
}

}  // namespace lacuna::tools
