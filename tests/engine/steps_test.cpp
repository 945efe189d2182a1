// SPDX-License-Identifier: Apache-2.0
// A run as units, in whatever order and however often they are done.
#include "engine/steps.hpp"

#include "engine/kept_state.hpp"
#include "engine/model/task_share.hpp"
#include "engine/parts/kept_files.hpp"
#include "engine/parts/parts.hpp"
#include "engine/pipeline.hpp"
#include "tests/support/detected.hpp"

namespace lacuna {
namespace {

Cloud scan() {
  return plane(60).punched({18, 20}, 5).jittered(0.3, 5).with_duplicates(200, 1).with_outliers(3, 2, 1);
}

struct SharedRun {
  explicit SharedRun(LoopMethod method = LoopMethod::kTangential) {
    config.run.tile_points = 400;
    config.run.threads = 2;
    config.run.workspace = (folder / "workspace").string();
    config.loops.method = method;
    config.results.points = true;
    fs::create_directory(folder / "workspace");
  }

  std::vector<Step> planned(std::size_t tasks) {
    MemoryScan input(cloud);
    // As of a large scan, so that there are several steps.
    return plan(input, config, tasks, tasks * 400'000);
  }
  bool work_on(const Step& step, std::size_t task) const {
    MemoryScan input(cloud);
    const ScratchFolder scratch;
    NoProgress quiet;
    return do_task(input, config, step, task, scratch.path(), quiet);
  }
  Step step(const char* name) const { return step_of_name(name, config.run.workspace).value(); }
  std::string bytes() const { return run_engine(cloud, config).bytes(); }
  std::string expected() const {
    Config alone = config;
    alone.run.workspace.clear();
    return run_engine(cloud, alone).bytes();
  }

  ScratchFolder folder;
  Cloud cloud = scan();
  Config config;
};

TEST_CASE("units of any number of tasks give the result of one process") {
  for (const LoopMethod method : {LoopMethod::kTangential, LoopMethod::kPaper}) {
    for (const std::size_t tasks : {1, 2, 7, 40}) {
      SharedRun run(method);
      const std::vector<Step> steps = run.planned(tasks);
      const std::size_t of_levels = method == LoopMethod::kPaper ? 2 : 6;
      CHECK(steps.size() == of_levels + (tasks > 1 ? 3 : 0));
      for (const Step& step : steps)
        for (std::size_t task = step.tasks; task-- > 0;) CHECK(run.work_on(step, task));
      const auto state = state_of(run.config.run.workspace);
      REQUIRE(state);
      CHECK(state->levels.front().evaluated == state->levels.front().tiles);
      INFO(tasks << " tasks");
      CHECK(run.bytes() == run.expected());
    }
  }
}

TEST_CASE("units that are lost, done twice, out of order or at the same time change nothing") {
  Random random(5);
  for (int round = 0; round < 6; ++round) {
    SharedRun run;
    struct Unit {
      Step step;
      std::size_t task;
    };
    std::vector<Unit> units;
    for (const Step& step : run.planned(3)) {
      for (std::size_t task = 0; task < step.tasks; ++task)
        for (std::int64_t copies = random.whole(0, 2); copies > 0; --copies) units.push_back({step, task});
    }
    for (std::size_t i = units.size(); i-- > 1;)
      std::swap(units[i], units[static_cast<std::size_t>(random.whole(0, static_cast<std::int64_t>(i)))]);
    const auto every_second = [&](std::size_t first) {
      for (std::size_t i = first; i < units.size(); i += 2) run.work_on(units[i].step, units[i].task);
    };
    std::thread other([&] { every_second(1); });
    every_second(0);
    other.join();
    INFO("round " << round);
    CHECK(run.bytes() == run.expected());
  }
}

TEST_CASE("the tasks of a step share its tiles: none is evaluated twice") {
  SharedRun run;
  run.planned(5);
  std::size_t before = 0, all = 0;
  for (std::size_t task = 0; task < 5; ++task) {
    run.work_on(run.step("evaluate-0"), task);
    const LevelState level = state_of(run.config.run.workspace)->levels.front();
    CHECK(level.evaluated > before);
    before = level.evaluated;
    all = level.tiles;
  }
  CHECK(before == all);
}

TEST_CASE("another plan makes levels of its own, and what an earlier one has left does not count") {
  SharedRun run;
  const auto points = [&](std::size_t tasks) {
    for (const Step& step : run.planned(tasks))
      for (std::size_t task = 0; task < step.tasks; ++task) run.work_on(step, task);
    return state_of(run.config.run.workspace)->levels.front().points;
  };
  const std::uint64_t before = points(7);
  CHECK(points(2) == before);
  CHECK(run.bytes() == run.expected());
}

TEST_CASE("a planned folder gives a run with other parameters what a fresh run gives") {
  std::vector<Config> others(5, SharedRun().config);
  others[0].scale.min_hole = 8;
  others[1].scale.min_hole = 50;  // leaves some hundred points
  others[2].scale.resolution = 1.7;
  others[3].loops.method = LoopMethod::kPaper;
  others[4].coherence.threshold = 0.4;
  std::size_t done = 0;  // steps before the run
  for (const std::size_t tasks : {3, 7}) {
    for (const Config& other : others) {
      SharedRun run;
      const std::string first = run.expected();
      const std::vector<Step> steps = run.planned(tasks);
      done = (done + 1) % steps.size();
      for (const Step& step : std::span(steps).first(done))
        for (std::size_t task = 0; task < step.tasks; ++task) run.work_on(step, task);
      const auto with = [&](Config config) {
        config.run.workspace = run.config.run.workspace;
        std::swap(run.config, config);
        const bool is_fresh = run.bytes() == run.expected();
        std::swap(run.config, config);
        return is_fresh;
      };
      INFO(tasks << " tasks, " << done << " steps");
      CHECK(with(other));
      CHECK(run.bytes() == first);
    }
  }
}

TEST_CASE("a shared scan without a finite point is refused by the first pass over it") {
  // Counts the passes over it.
  struct CountedScan final : MemoryScan {
    using MemoryScan::MemoryScan;
    void rewind_to(const IndexRange& parts, PointId first) override {
      ++passes;
      MemoryScan::rewind_to(parts, first);
    }
    void refuse_empty() const override { throw Error("has no point"); }
    int passes = 0;
  };
  SharedRun run;
  run.cloud.positions.assign(1000, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  run.planned(2);
  for (const char* const step : {"survey", "tiles", "bucket", "level-0"}) {
    CountedScan input(run.cloud);
    const ScratchFolder scratch;
    NoProgress quiet;
    CHECK_THROWS_WITH(do_task(input, run.config, run.step(step), 0, scratch.path(), quiet), "has no point");
    CHECK(input.passes == 1);
  }
}

TEST_CASE("a level that the scan does not have is nothing to do") {
  SharedRun run;
  run.planned(2);
  CHECK_FALSE(run.work_on(run.step("level-60"), 0));
  CHECK_FALSE(run.work_on(run.step("evaluate-60"), 1));
  CHECK(run.bytes() == run.expected());
}

TEST_CASE("other names than those of steps are none") {
  SharedRun run;
  run.planned(4);
  for (const char* name : {"", "level", "level-", "level--1", "evaluate-0x", "evaluate-500", "tiles-0"})
    CHECK_FALSE(step_of_name(name, run.config.run.workspace));
  const ScratchFolder without_plan;
  CHECK_THROWS_WITH(step_of_name("evaluate-0", without_plan.path()), Contains("has no plan"));
}

// ---- Shares of tasks

TEST_CASE("tasks share things in runs of about equal weights, each thing once") {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::uint64_t> weights;
    for (std::int64_t left = random.whole(1, 40); left > 0; --left)
      weights.push_back(static_cast<std::uint64_t>(random.whole(1, 100)));
    const auto tasks = static_cast<std::size_t>(random.whole(1, 12));
    const std::uint64_t all = std::accumulate(weights.begin(), weights.end(), std::uint64_t{0});
    const std::uint64_t heaviest = *std::max_element(weights.begin(), weights.end());
    std::size_t next = 0;
    for (std::size_t task = 0; task < tasks; ++task) {
      const IndexRange range = share_of(weights, {task, tasks});
      CHECK(range.first == next);
      REQUIRE(range.last >= range.first);
      next = range.last;
      std::uint64_t mine = 0;
      for (std::size_t i = range.first; i < range.last; ++i) mine += weights[i];
      CHECK(mine <= all / tasks + heaviest + 1);
    }
    CHECK(next == weights.size());
  }
}

}  // namespace
}  // namespace lacuna
