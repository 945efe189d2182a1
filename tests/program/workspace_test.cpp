// SPDX-License-Identifier: Apache-2.0
// detect --workspace: a run that is stopped, however, goes on to the results of an undisturbed one.
#include "tests/support/draws.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/sheet.hpp"
#include "tests/support/skip.hpp"
#include "tests/support/system.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace lacuna::test {
namespace {

struct Run {
  ScratchFolder folder;
  int side = static_cast<int>(std::sqrt(static_cast<double>(draws(40'000))));
  int points = side * side;
  std::string scan = folder.write("scan.txt", sheet(side));
  fs::path workspace = folder / "workspace";

  Words arguments(const fs::path& out, const Words& more) const {
    const std::string tile_points = std::to_string(points / 150);
    return with({"detect", scan, "--out", out.string(), "--tile-points", tile_points, "--points", "--quiet",
                 "--threads", "2"},
                more);
  }
  Words kept() const { return arguments(folder / "out", {"--workspace", workspace.string()}); }
  // Requires that a run without a workspace has the same results.
  void check_results() const {
    const fs::path without = folder / "without";
    if (!fs::exists(without)) succeed(arguments(without, {}));
    check_same_results(folder / "out", without);
  }
};

TEST_CASE("a run that is killed at any moment goes on to the same results") {
  const Run run;
  std::size_t killed = 0;
  for (std::size_t entries = 1; entries < 40; entries += 4) {
    const auto has_entries = [&] {
      return fs::exists(run.workspace) && count_entries(run.workspace) >= entries;
    };
    const ProgramResult stopped = run_program_until(run.kept(), SIGKILL, has_entries);
    killed += stopped.exit_code == 128 + SIGKILL;
    if (entries % 3 != 0) continue;  // others are killed once more before they end
    succeed(run.kept());
    run.check_results();
    fs::remove_all(run.workspace);
  }
  CHECK(killed > 5);
  succeed(run.kept());
  run.check_results();
}

TEST_CASE("a signal says how to go on, and what is done stays") {
  const Run run;
  const auto has_level = [&] { return fs::exists(run.workspace / "level-0-0.lacuna"); };
  const ProgramResult stopped = run_program_until(run.kept(), SIGTERM, has_level);
  REQUIRE(stopped.exit_code == 128 + SIGTERM);
  CHECK_THAT(stopped.err, EndsWith("; the same command goes on from " + run.workspace.string() + "\n"));
  CHECK(fs::exists(run.workspace / "level-0-0.lacuna"));
  CHECK_FALSE(fs::exists(run.folder / "out"));
  CHECK_THAT(run_program({"status", run.workspace.string()}).out,
             Contains("level 0: ") && Contains(" tiles evaluated, ") && Contains(" left") &&
                 Contains("scan.txt, ") && Contains(" bytes, written 20") && !Contains(" ns"));
}

TEST_CASE("a workspace on a full disk is an error, and its parts are used elsewhere", "[.slow]") {
  const Run run;
  std::size_t failed = 0;
  for (const int bytes_a_point : {1, 12, 35, 70, 105, 140, 175, 233, 291, 350}) {
    const SmallDisk disk(run.folder / "disk", std::to_string(bytes_a_point * run.points));
    if (!disk.mounted()) return skip("cannot mount a small disk");
    INFO(bytes_a_point << " bytes a point");
    const fs::path small = disk.path() / "workspace";
    const ProgramResult result = run_program(run.arguments(
        run.folder / "out", {"--workspace", small.string(), "--scratch", run.folder.path().string()}));
    if (result.exit_code == 0) continue;
    ++failed;
    CHECK(result.exit_code == 1);
    CHECK_THAT(result.err, Contains("lacuna: error: ") &&
                               (Contains("No space left on device") || Contains("the run needs at least")));
    if (!fs::exists(small)) continue;
    fs::copy(small, run.workspace);
    succeed(run.kept());
    run.check_results();
    fs::remove_all(run.workspace);
  }
  CHECK(failed >= 4);
}

TEST_CASE("another run at the same time is refused, and with another input, what differs is made again") {
  const Run run{.side = 60};
  succeed(run.kept());
  const int other = ::open(run.workspace.c_str(), O_RDONLY | O_DIRECTORY);
  REQUIRE(::flock(other, LOCK_EX) == 0);
  check_failure(run_program(run.kept()), 1, "workspace: another run is at work there");
  ::close(other);
  run.folder.write("scan.txt", sheet(run.side - 1));
  succeed(run.kept());
  run.check_results();
  Words told = run.kept();
  std::erase(told, "--quiet");
  run.folder.write("scan.txt", sheet(run.side - 2));
  const std::string err = run_program(told).err;
  CHECK_THAT(err, Contains("lacuna: level-0 is made again, and what follows from it"));
  CHECK(err.find("made again") == err.rfind("made again"));
}

TEST_CASE("clean removes a workspace, but no file of others") {
  const Run run{.side = 40};
  succeed(run.kept());
  run.folder.write("workspace/notes.txt", "x");
  const ProgramResult cleaned = run_program({"clean", run.workspace.string()});
  CHECK(cleaned.exit_code == 0);
  CHECK_THAT(cleaned.out, Contains("where other files stay"));
  CHECK(count_entries(run.workspace) == 1);
  check_failure(run_program({"clean", run.workspace.string()}), 1, "not the workspace of a run");
  check_failure(run_program({"status", run.workspace.string()}), 1, "not the workspace of a run");
  fs::remove(run.workspace / "notes.txt");
  succeed(run.kept());
  fs::create_directory_symlink(run.workspace, run.folder / "link");
  CHECK(run_program({"clean", (run.folder / "link").string()}).exit_code == 0);
  CHECK(fs::is_empty(run.workspace));
  CHECK(fs::is_symlink(run.folder / "link"));
  succeed(run.kept());
  CHECK(run_program({"clean", run.workspace.string()}).exit_code == 0);
  CHECK_FALSE(fs::exists(run.workspace));
}

}  // namespace
}  // namespace lacuna::test
