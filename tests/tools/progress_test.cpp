// SPDX-License-Identifier: Apache-2.0
#include "tools/console/progress.hpp"

#include "tests/support/test.hpp"

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

TEST_CASE("the share of the run and its time left follow the step, and the bar is the run's") {
  StepProgress progress = evaluating();
  progress.run_share = 0.25;
  CHECK(*progress.run_seconds_left() == Approx(225));
  CHECK(progress_text(progress) ==
        "evaluate: 40 %, 1.60 M points/s, 3.00 s left; run: 25 %, 1:15 min, 3:45 min left");
  CHECK_THAT(progress_bar(progress, 100), StartsWith("lacuna  [==        ]  evaluate: 40 %"));
  CHECK(progress_json(progress) ==
        R"({"step": "evaluate", "share": 0.400, "seconds": 2.000, "seconds_left": 3.000, "points": 3200000, )"
        R"("run_share": 0.250, "run_seconds": 75.000, "run_seconds_left": 225.000})");
  progress = {.step = "nest"};
  CHECK(progress_json(progress) ==
        R"({"step": "nest", "share": null, "seconds": 0.000, "seconds_left": null, "points": 0, )"
        R"("run_share": null, "run_seconds": 0.000, "run_seconds_left": null})");
}

TEST_CASE("a run goes from 0 to 1 through its steps, whether they count points or not") {
  Config config;
  for (const bool has_area : {false, true}) {
    for (const double resolution : {0.0, 0.5}) {
      config.scale.resolution = resolution;
      const RunSteps steps = steps_of_run(config, has_area);
      CHECK(run_share(steps, steps.front(), 0) == 0.0);
      CHECK(*run_share(steps, steps.back(), 1) == Approx(1));
      for (std::size_t i = 1; i < steps.size(); ++i) {
        CHECK(*run_share(steps, steps[i], 0) == Approx(*run_share(steps, steps[i - 1], 1)));
        CHECK(*run_share(steps, steps[i], 0) <= *run_share(steps, steps[i], 1));
      }
    }
  }
  CHECK(*run_share(steps_of_check(), "voids", 0) == Approx(0.8));
  CHECK_FALSE(run_share(steps_of_check(), "evaluate", 0));
  CHECK_FALSE(run_share({}, "evaluate", 0));
}

TEST_CASE("a counted run knows its step, its points and its share, and a step that has ended is whole") {
  CountedProgress progress(steps_of_check());
  CHECK(progress.state().step.empty());
  progress.begin("area", 100);
  progress.advance(30);
  progress.advance(20);
  CHECK(progress.state().step == "area");
  CHECK(progress.state().done == 50);
  CHECK(*progress.state().run_share == Approx(0.4));
  progress.begin("voids", 0);
  CHECK(*progress.state().run_share == Approx(0.8));
  progress.end();
  CHECK(*progress.state().share() == 1);
  CHECK(*progress.state().run_share == Approx(1));
}

TEST_CASE("the time left of a step follows from its share and its time") {
  StepProgress progress = evaluating();
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
