// SPDX-License-Identifier: Apache-2.0
// A workspace that is kept, and a run as units in whatever order: the result is that of an undisturbed run.
#include "engine/steps.hpp"

#include "engine/kept_state.hpp"
#include "engine/model/task_share.hpp"
#include "engine/parts/kept_run.hpp"
#include "engine/parts/parts.hpp"
#include "engine/pipeline.hpp"
#include "tests/support/detected.hpp"

namespace lacuna {
namespace {

Cloud scan() {
  return plane(60).punched({18, 20}, 5).jittered(0.3, 5).with_duplicates(200, 1).with_outliers(3, 2, 1);
}

// Several tiles at the lower levels.
Config small_tiles(Config config = {}) {
  config.run.tile_points = 400;
  config.run.threads = 2;
  return config;
}

std::string bytes_of(const Cloud& cloud, Config config, const fs::path& workspace) {
  config.run.workspace = workspace.string();
  return run_engine(cloud, config).bytes();
}

// The steps whose kept parts are made again.
struct MadeAgain final : Progress {
  void begin(std::string_view, std::uint64_t) override {}
  void advance(std::uint64_t) override {}
  void end() noexcept override {}
  void make_again(std::string_view step) override { steps.emplace_back(step); }
  std::vector<std::string> steps;
};

std::vector<Config> all_configs() {
  std::vector<Config> configs(4);
  configs[1].loops.method = LoopMethod::kPaper;
  configs[2].normals.orient = true;
  configs[3].scale.min_hole = 8;  // a first level of representatives
  for (Config& config : configs) config = small_tiles(config);
  return configs;
}

void copy_files(const fs::path& from, const fs::path& to) {
  fs::remove_all(to);
  fs::copy(from, to, fs::copy_options::recursive);
}

TEST_CASE("a run with a workspace, and one that goes on from all of it, give the result of one without") {
  for (const Config& config : all_configs()) {
    const ScratchFolder folder;
    const std::string expected = run_engine(scan(), config).bytes();
    CHECK(bytes_of(scan(), config, folder.path()) == expected);
    CHECK(bytes_of(scan(), config, folder.path()) == expected);
    const auto state = state_of(folder.path());
    REQUIRE(state);
    CHECK(state->levels.size() == (config.loops.method == LoopMethod::kPaper ? 1 : state->levels.size()));
    for (const LevelState& level : state->levels) {
      CHECK(level.tiles > 0);
      CHECK(level.evaluated == level.tiles);
    }
  }
}

TEST_CASE("a run goes on from whatever parts there are, whole, damaged or cut") {
  Random random(3);
  for (const Config& config : all_configs()) {
    const ScratchFolder folder;
    const fs::path all = folder / "all", some = folder / "some";
    fs::create_directory(all);
    const std::string expected = bytes_of(scan(), config, all);
    for (int round = 0; round < 12; ++round) {
      copy_files(all, some);
      for (const fs::path& file : kept_files(some)) {
        const auto size = static_cast<std::int64_t>(fs::file_size(file));
        const std::int64_t what = random.whole(0, 5);
        if (what == 0) {
          fs::remove(file);
        } else if (what == 1) {
          fs::resize_file(file, static_cast<std::uintmax_t>(random.whole(0, size)));
        } else if (what == 2 && size > 0) {
          std::string content = test::read_file(file);
          content[static_cast<std::size_t>(random.whole(0, size - 1))] ^= 4;
          folder.write("damaged", content);
          fs::rename(folder / "damaged", file);
        }
      }
      fs::remove(some / "run.lacuna");  // as its end may be what was damaged
      fs::copy_file(all / "run.lacuna", some / "run.lacuna");
      INFO("round " << round);
      CHECK(bytes_of(scan(), config, some) == expected);
    }
  }
}

// The only part with outputs of a level.
fs::path outputs_of(const ScratchFolder& folder, std::size_t level) {
  fs::path found;
  for (const fs::path& file : kept_files(folder.path())) {
    if (!is_of_step(file, "evaluate-" + std::to_string(level))) continue;
    CHECK(found.empty());
    found = file;
  }
  return found;
}

TEST_CASE("later steps take other parameters, and the parts before them are used again") {
  const ScratchFolder folder;
  bytes_of(scan(), small_tiles(), folder.path());
  const auto written = fs::last_write_time(folder / "level-0-0.lacuna");
  Config selected = small_tiles();
  selected.selection.min_confidence = 0.9;
  const fs::path outputs = outputs_of(folder, 0);
  CHECK(bytes_of(scan(), selected, folder.path()) == run_engine(scan(), selected).bytes());
  CHECK(outputs_of(folder, 0) == outputs);
  Config threshold = small_tiles();
  threshold.coherence.threshold = 0.4;
  threshold.results.points = true;
  CHECK(bytes_of(scan(), threshold, folder.path()) == run_engine(scan(), threshold).bytes());
  CHECK_FALSE(outputs_of(folder, 0).empty());  // the only ones
  CHECK(fs::last_write_time(folder / "level-0-0.lacuna") == written);
  Config run = small_tiles();
  run.run.threads = 1;
  run.run.tile_points = 900;
  run.run.memory_limit = 100 << 20;
  CHECK(bytes_of(scan(), run, folder.path()) == run_engine(scan(), run).bytes());
  CHECK(fs::last_write_time(folder / "level-0-0.lacuna") == written);
}

TEST_CASE("outputs that an earlier run did not want are found by the next one") {
  const ScratchFolder folder;
  bytes_of(scan(), small_tiles(), folder.path());
  std::vector<Config> configs(3, small_tiles());
  configs[0].normals.orient = true;
  configs[1].results.points = true;
  configs[2].results.sample_points = 0;
  for (const Config& config : configs)
    CHECK(bytes_of(scan(), config, folder.path()) == run_engine(scan(), config).bytes());
}

TEST_CASE("with another input or parameter, what differs is made again, and the run says so") {
  using Steps = std::vector<std::string>;
  const ScratchFolder folder;
  bytes_of(scan(), small_tiles(), folder.path());
  const auto made_again = [&](const Cloud& cloud, const Config& changed) {
    MadeAgain progress;
    Config kept = changed;
    kept.run.workspace = folder.path().string();
    MemoryScan input(cloud);
    CHECK(run_engine(input, kept, progress).bytes() == run_engine(cloud, changed).bytes());
    return progress.steps;
  };
  Config config = small_tiles();
  config.neighbourhood.k = 20;
  CHECK(made_again(scan(), config).at(0) == "level-0");
  CHECK(made_again(scan(), config).empty());
  config.coherence.threshold = 0.4;
  CHECK(made_again(scan(), config).at(0) == "evaluate-0");
  CHECK(made_again(scan().translated({1, 0, 0}), config).at(0) == "level-0");
  std::string content = test::read_file(folder / "loops-1-0.lacuna");
  fs::rename(folder.write("damaged", content.substr(0, 100)), folder / "loops-1-0.lacuna");
  CHECK(made_again(scan().translated({1, 0, 0}), config) == Steps{"loops-1"});
}

TEST_CASE("a run whose own part, or plan, is damaged goes on, and the workspace keeps its state") {
  const ScratchFolder folder;
  const std::string expected = bytes_of(scan(), small_tiles(), folder.path());
  write_plan(folder.path(), {.tasks = 3});
  for (const char* part : {"run.lacuna", "plan.lacuna"}) {
    std::string content = test::read_file(folder / part);
    content[part == std::string("run.lacuna") ? content.size() / 2 : 0] ^= 1;
    fs::rename(folder.write("damaged", content), folder / part);
  }
  CHECK_FALSE(read_plan(folder.path()));
  const auto state = state_of(folder.path());
  REQUIRE(state);
  CHECK(state->made_from.empty());
  CHECK(state->levels.size() > 2);
  CHECK(bytes_of(scan(), small_tiles(), folder.path()) == expected);
}

TEST_CASE("a folder with others' files of the names of parts is refused, and they stay") {
  const ScratchFolder folder;
  folder.write("level-0-0.lacuna", "notes on level 0");
  CHECK_THROWS_WITH(bytes_of(scan(), small_tiles(), folder.path()),
                    Contains("level-0-0.lacuna: is not of a workspace"));
  CHECK(test::read_file(folder / "level-0-0.lacuna") == "notes on level 0");
  CHECK(folder.names() == std::vector<std::string>{"level-0-0.lacuna"});
  CHECK_FALSE(state_of(folder.path()));
  CHECK(kept_files(folder.path()).empty());
}

TEST_CASE("parts without the run's own, which a late task leaves, are a workspace as any other") {
  const ScratchFolder folder;
  const std::string expected = bytes_of(scan(), small_tiles(), folder.path());
  fs::remove(folder / "run.lacuna");
  CHECK(state_of(folder.path()));
  CHECK(bytes_of(scan(), small_tiles(), folder.path()) == expected);
}

TEST_CASE("other files in a workspace stay, and what was not finished goes") {
  const ScratchFolder folder;
  folder.write("notes.txt", "x");
  bytes_of(scan(), small_tiles(), folder.path());
  folder.write("evaluate-0-0123456789abcdef.lacuna.0123456789abcdef.partial", "x");
  folder.write("level-3-0123456789abcdef.points.lacuna.partial", "x");
  const std::vector<std::string> others = {"other.partial", "results.csv", "notes.lacuna",
                                           "notes.lacuna.partial"};
  for (const std::string& other : others) folder.write(other, "x");
  bytes_of(scan(), small_tiles(), folder.path());
  CHECK(fs::exists(folder / "notes.txt"));
  for (const std::string& other : others) CHECK(fs::exists(folder / other));
  for (const fs::path& file : kept_files(folder.path()))
    CHECK(std::ranges::count(others, file.filename().string()) == 0);
  CHECK_FALSE(fs::exists(folder / "evaluate-0-0123456789abcdef.lacuna.0123456789abcdef.partial"));
  CHECK_FALSE(fs::exists(folder / "level-3-0123456789abcdef.points.lacuna.partial"));
}

// ---- A run as units

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
