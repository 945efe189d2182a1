// SPDX-License-Identifier: Apache-2.0
#include "tools/console/run_share.hpp"

#include "engine/thin/thin.hpp"

#include <algorithm>

namespace lacuna::tools {
namespace {

struct StepWeight {
  std::string_view step;
  double weight;
};

// In the order of a run. Weights are per cent of its time: means of a terrestrial scan of 1.0 M points and
// of an object of 0.8 M. Those of `thin`, `orient`, `area` and `voids` are from runs that have these steps.
constexpr StepWeight kWeights[] = {
    {"survey", 4}, {"bucket", 3},  {"order", 3},   {"thin", 4},    {"halo", 3},  {"evaluate", 29},
    {"loops", 17}, {"levels", 30}, {"track", 1},   {"measure", 0}, {"nest", 0},  {"coherence", 0},
    {"sample", 4}, {"orient", 4},  {"collect", 1}, {"area", 4},    {"voids", 1}, {"write", 5}};

double weight_of(std::string_view step) {
  const auto found = std::ranges::find(kWeights, step, &StepWeight::step);
  return found == std::end(kWeights) ? 0 : found->weight;
}

}  // namespace

RunSteps steps_of_run(const Config& config, bool has_area) {
  RunSteps steps;
  for (const StepWeight& weight : kWeights) steps.push_back(weight.step);
  std::erase_if(steps, [&](std::string_view step) {
    if (step == "thin") return first_edge(config.scale) == 0;
    if (step == "levels" || step == "track") return !has_levels(config);
    if (step == "orient") return !config.normals.orient;
    if (step == "area" || step == "voids") return !has_area;
    return false;
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

}  // namespace lacuna::tools
