// SPDX-License-Identifier: Apache-2.0
// A workspace that is kept: whatever of it is there, the result is that of an undisturbed run.
#include "engine/parts/kept_run.hpp"

#include "engine/kept_state.hpp"
#include "engine/parts/kept_files.hpp"
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

}  // namespace
}  // namespace lacuna
