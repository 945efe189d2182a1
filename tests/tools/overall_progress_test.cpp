// SPDX-License-Identifier: Apache-2.0
#include "tools/console/overall_progress.hpp"

#include <algorithm>

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

TEST_CASE("counts beyond the total do not exceed the stage") {
  OverallProgress progress({{"a", 1}, {"b", 1}});
  progress.begin("a", 0);
  CHECK(progress.at(1, 500, 100).share == Approx(0.5));
}

TEST_CASE("the expected stages are those of the config") {
  const auto names = [](const Config& config) {
    std::vector<std::string> all;
    for (const ExpectedStage& stage : expected_stages(config)) all.push_back(stage.name);
    return all;
  };
  const auto has = [&](const Config& config, const char* name) {
    const auto all = names(config);
    return std::find(all.begin(), all.end(), name) != all.end();
  };
  Config config;
  CHECK(names(config) == std::vector<std::string>{"survey", "bucket", "halo", "evaluate", "loops", "levels",
                                                  "track", "measure", "nest", "coherence", "sample",
                                                  "collect", "write"});
  config.scale.every_point = true;
  CHECK(!has(config, "levels"));
  config.scale = {.min_hole = 0.2};
  CHECK(names(config)[2] == "thin");
  const double without = expected_stages(config).back().weight;
  config.results.points = true;
  CHECK(expected_stages(config).back().weight > without);
}

}  // namespace
}  // namespace lacuna::tools
