// SPDX-License-Identifier: Apache-2.0
#include "tools/console/overall_progress.hpp"

#include "tools/console/shown_progress.hpp"

#include <catch2/catch.hpp>

namespace lacuna::tools {
namespace {

TEST_CASE("the share of a run is that of its stages by weight, and the rest takes time in proportion") {
  OverallProgress progress({{"read", 1}, {"work", 8}, {"write", 1}});
  progress.begin("read", 0);
  CHECK(progress.at(0, 0, 100).share == 0);
  CHECK_FALSE(progress.at(0, 0, 100).seconds_left);
  CHECK(progress.at(1, 50, 100).share == Approx(0.05));
  CHECK(*progress.at(1, 50, 100).seconds_left == Approx(19));
  progress.end();
  progress.begin("work", 2);
  CHECK(progress.at(2, 0, 100).share == Approx(0.1));
  CHECK(progress.at(10, 50, 100).share == Approx(0.5));
  CHECK(*progress.at(10, 50, 100).seconds_left == Approx(10));
  progress.end();
  progress.begin("write", 18);
  progress.end();
  CHECK(progress.at(20, 0, 0).share == 1);
  CHECK(*progress.at(20, 0, 0).seconds_left == 0);
}

TEST_CASE("a stage that was not expected never takes the share back, one that does not come is passed over") {
  OverallProgress progress({{"survey", 1}, {"bucket", 1}, {"rare", 50}, {"halo", 1}, {"write", 1}});
  double last = 0;
  double seconds = 0;
  for (const char* stage : {"survey", "bucket", "thin", "survey", "bucket", "halo", "unheard of", "write"}) {
    progress.begin(stage, seconds);
    for (std::uint64_t done = 0; done <= 4; ++done, ++seconds) {
      const auto state = progress.at(seconds, done, 4);
      CHECK(state.share >= last);
      CHECK(state.share <= 1);
      CHECK(state.seconds_left.value_or(0) >= 0);
      last = state.share;
    }
    progress.end();
  }
  CHECK(progress.at(seconds, 0, 0).share == 1);
}

TEST_CASE("a stage whose size is not known advances with time and is never through before its end") {
  OverallProgress progress({{"read", 1}, {"loops", 1}});
  progress.begin("read", 0);
  progress.end();
  progress.begin("loops", 10);
  CHECK(progress.at(10, 0, 0).share == Approx(0.5));
  CHECK(progress.at(20, 0, 0).share == Approx(0.75));  // as long as the pace so far gives it
  CHECK(progress.at(1e9, 7, 0).share < 1);
  OverallProgress first({{"loops", 1}});
  first.begin("loops", 0);
  CHECK(first.at(0, 0, 0).share == 0);
  CHECK(first.at(1e9, 0, 0).share < 1);
}

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
