// SPDX-License-Identifier: Apache-2.0
#include "tools/console/progress.hpp"

#include <catch2/catch.hpp>

namespace lacuna::tools {
namespace {

StepProgress evaluating() {
  return {.step = "evaluate", .done = 3'200'000, .total = 8'000'000, .step_seconds = 2, .run_seconds = 75};
}

TEST_CASE("a line of progress has the step, its share, speed and time left, and the time of the run") {
  StepProgress progress = evaluating();
  CHECK(progress_text(progress) == "evaluate: 40 %, 1.60 M points/s, 3.00 s left; run: 1:15 min");
  CHECK(progress_bar(progress, 100) ==
        "lacuna  [====      ]  evaluate: 40 %, 1.60 M points/s, 3.00 s left; run: 1:15 min");
  CHECK(progress_bar(progress, 20) == "lacuna  [====      ");
  progress.total = 0;
  CHECK(progress_text(progress) == "evaluate: 1.60 M points/s; run: 1:15 min");
  progress.done = 0;
  CHECK(progress_text(progress) == "evaluate; run: 1:15 min");
  progress.total = 100;
  CHECK(progress_text(progress) == "evaluate: 0 %; run: 1:15 min");
}

TEST_CASE("the time left of a step follows from its share and its time") {
  StepProgress progress = evaluating();
  CHECK(*progress.share() == Approx(0.4));
  CHECK(*progress.seconds_left() == Approx(3));
  progress.done = 9'000'000;  // counts beyond the total do not exceed the step
  CHECK(*progress.share() == 1);
  CHECK(*progress.seconds_left() == 0);
  progress.done = 0;
  CHECK(*progress.share() == 0);
  CHECK_FALSE(progress.seconds_left());
  progress.total = 0;
  CHECK_FALSE(progress.share());
}

TEST_CASE("the progress bar is shorter than the terminal is wide, whatever it shows") {
  for (std::size_t width = 0; width < 200; ++width) {
    for (const std::uint64_t done : {0ull, 1ull, 1000ull, ~0ull}) {
      for (const double seconds : {0.0, 1e-9, 100.0, 1e12}) {
        const StepProgress progress{.step = "a step with a long name",
                                    .done = done,
                                    .total = 1000,
                                    .step_seconds = seconds,
                                    .run_seconds = seconds};
        REQUIRE(progress_bar(progress, width).size() <= (width > 0 ? width - 1 : 0));
      }
    }
  }
}

}  // namespace
}  // namespace lacuna::tools
