// SPDX-License-Identifier: Apache-2.0
#include "tools/console/shown_progress.hpp"

#include <catch2/catch.hpp>

namespace lacuna::tools {
namespace {

ProgressState evaluating() {
  return {.stage = "evaluate",
          .done = 3'200'000,
          .total = 10'000'000,
          .stage_seconds = 2,
          .seconds = 12.3456,
          .overall = {.share = 0.379, .seconds_left = 41.2}};
}

TEST_CASE("the progress bar shows the share of the run, the stage, its rate and the time left of the run") {
  ProgressState state = evaluating();
  CHECK(progress_bar(state, 70) == "lacuna  37 %  [===      ]  evaluate    1.60 M points/s  0:42 min left");
  CHECK(progress_bar(state, 62) == "lacuna  37 %  evaluate    1.60 M points/s  0:42 min left");
  CHECK(progress_bar(state, 20) == "lacuna  37 %  evalu");
  state.overall = {.share = 1, .seconds_left = 3723};
  CHECK(progress_bar(state, 62) == "lacuna 100 %  evaluate    1.60 M points/s  1:02:03 h left");
  state.done = 0;
  state.overall = {};
  CHECK(progress_bar(state, 42) == "lacuna   0 %  evaluate                   ");
}

TEST_CASE("the progress bar is shorter than the terminal is wide, whatever it shows") {
  for (std::size_t width = 0; width < 200; ++width) {
    for (const std::uint64_t done : {0ull, 1ull, 1000ull, ~0ull}) {
      for (const double seconds : {0.0, 1e-9, 100.0, 1e12}) {
        const ProgressState state{.stage = "a stage with a long name",
                                  .done = done,
                                  .stage_seconds = seconds,
                                  .overall = {.share = 1, .seconds_left = seconds}};
        REQUIRE(progress_bar(state, width).size() <= (width > 0 ? width - 1 : 0));
      }
    }
  }
}

}  // namespace
}  // namespace lacuna::tools
