// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/loop_scores.hpp"

#include "tests/support/test.hpp"

namespace lacuna::evaluation {

TEST_CASE("the area under the ROC curve is the share of pairs in the right order") {
  const auto area = [](std::vector<EdgeDecision> verdicts, std::vector<double> confidence) {
    std::vector<LoopMatch> loops;
    for (const EdgeDecision verdict : verdicts) loops.push_back({.verdict = verdict});
    return area_under_roc(loops, confidence);
  };
  using enum EdgeDecision;
  CHECK(area({kFound, kRepeated, kFalse, kFalse}, {0.9, 0.8, 0.2, 0.1}) == 1);
  CHECK(area({kFound, kFound, kFalse, kFalse}, {0.9, 0.15, 0.2, 0.1}) == 0.75);
  CHECK(area({kFound, kFalse}, {0.5, 0.5}) == 0.5);
  CHECK(area({kFound, kFalse}, {0.1, 0.2}) == 0);
  CHECK(area({kFound, kFalse, kShort, kFalse}, {0.5, 0.4, 0.1, std::nan("")}) == 1);
  CHECK(area({kFound, kJoined, kParted, kFalse}, {0.5, 0.9, 0.1, 0.4}) == 1);
  CHECK_FALSE(area({kFound, kFound}, {0.5, 0.4}));
  CHECK_FALSE(area({kFalse}, {0.5}));
  CHECK_FALSE(area({}, {}));
}

}  // namespace lacuna::evaluation
