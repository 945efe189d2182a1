// SPDX-License-Identifier: Apache-2.0
// Runs that go on from a workspace: after a signal, with other inputs, and shared by plan, work and finish.
// The folders that commands make and lock.
#include "tests/support/test.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/system.hpp"
#include "tools/run/run_program.hpp"

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

TEST_CASE("a killed run leaves no file but marks, and no folder of results") {
  const Run run;
  const ProgramResult result = run_program_beside(run.arguments(run.folder / "out", {}), [](pid_t program) {
    if (has_open(program, "points")) kill(program, SIGKILL);
  });
  REQUIRE(result.exit_code == 128 + SIGKILL);
  CHECK_FALSE(fs::exists(run.folder / "out"));
  std::size_t folders = 0, files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(temporary_of(run.folder / "out")))
    ++(entry.is_directory() ? folders : files);
  CHECK(folders == 2);  // for results and for temporary files
  CHECK(files == 2);    // the marks of these
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

namespace {

struct Shared {
  ScratchFolder folder;
  std::string workspace = (folder / "work space").string();

  Shared() {
    folder.write("a.txt", sheet(200));
    folder.write("b.txt", "0 0 9\n0 1 9\n1 0 9\n");
    folder.write("c.txt", "x y z nx ny nz\n2 2 7 0 0 1\n3 3 7 0 0 1\n900 3 7 0 0 1\n");
    folder.write("all.list", "c.txt\na.txt\nb.txt pose=1 0 0 5 0 1 0 0 0 0 1 0\n");
  }
  std::string list() const { return std::string("@").append((folder / "all.list").string()); }
  ProgramResult plan(const Words& more = {}) const {
    return run_program(with({"plan", list(), "--workspace", workspace, "--tasks", "3"}, more));
  }
};

TEST_CASE("plan, work and finish give the files of detect") {
  const Shared run;
  const Words options = {"--points", "--points-normals", "--k", "14", "--bounds", "0,0,290,290"};
  std::istringstream lines(run.plan(with({"--tsv"}, options)).out);
  std::vector<std::string> steps;
  std::string step;
  for (std::size_t tasks, mib, minutes; lines >> step >> tasks >> mib >> minutes;) {
    steps.push_back(step);
    CHECK(mib > 0);
    CHECK(minutes > 0);
    if (step == "finish") continue;
    for (std::size_t task = 0; task < tasks; ++task) {
      const ProgramResult worked =
          succeed({"work", run.workspace, "--step", step, "--task", std::to_string(task), "--threads", "1"});
      CHECK_THAT(worked.out, Contains(step + ", task " + std::to_string(task) + ": done"));
    }
  }
  CHECK(steps == std::vector<std::string>{"survey", "tiles", "bucket", "level-0", "evaluate-0", "finish"});
  succeed({"finish", run.workspace, "--out", (run.folder / "out").string(), "--quiet"});
  const fs::path alone = detect(run.list(), run.folder / "alone", options);
  CHECK(fs::exists(alone / "points" / "a.csv"));
  check_same_results(run.folder / "out", alone);
}

TEST_CASE("a plan says in a table what its tasks are, and wrong units are refused") {
  const Shared run;
  CHECK_THAT(run.plan().out, Contains("evaluate-0      3") && Contains("memory of a task"));
  const auto work = [&](const Words& arguments) {
    return run_program(with({"work", run.workspace}, arguments));
  };
  check_failure(work({"--step", "evaluate"}), 2, "--step: allowed: a step of lacuna plan");
  check_failure(work({"--step", "evaluate-0", "--task", "3"}), 2, "--task: allowed: 0 to 2");
  check_failure(work({}), 2, "--step is required");
  check_failure(run_program({"work", run.folder.path().string(), "--step", "level-0"}), 1,
                "not the workspace of a run");
  check_failure(run_program({"finish", run.workspace}), 2, "--out is required");
  check_failure(run_program({"plan", run.list(), "--tasks", "3"}), 2, "--workspace is required");
  run.folder.write("b.txt", "0 0 8\n0 1 9\n1 0 9\n");
  check_failure(work({"--step", "level-0"}), 1, "was planned for another run: \"input: ");
  // Another part in its place names no input: a run of no files would have no holes.
  fs::rename(fs::path(run.workspace) / "plan.lacuna", fs::path(run.workspace) / "run.lacuna");
  check_failure(run_program({"finish", run.workspace, "--out", (run.folder / "out").string()}), 1,
                "not the workspace of a run");
}

TEST_CASE("a task that ends after its workspace was cleaned fails, and its part stands in nobody's way") {
  const Shared run;
  REQUIRE(run.plan().exit_code == 0);
  const fs::path workspace = run.workspace;
  bool is_cleaned = false;
  const ProgramResult late =
      run_program_beside({"work", run.workspace, "--step", "evaluate-0", "--quiet"}, [&](pid_t task) {
        if (is_cleaned || !fs::exists(workspace / "level-0-0.lacuna")) return;
        ::kill(task, SIGSTOP);  // so that it does not end before
        is_cleaned = run_program({"clean", run.workspace}).exit_code == 0;
        ::kill(task, SIGCONT);
      });
  CHECK(is_cleaned);
  check_failure(late, 1, run.workspace);
  CHECK(run.plan().exit_code == 0);
  CHECK(run_program({"clean", run.workspace}).exit_code == 0);
  CHECK_FALSE(fs::exists(workspace));
}

}  // namespace

using namespace tools;

TEST_CASE("a lock that cannot be had is an error that names the folder") {
  const ScratchFolder folder;
  const auto lock = [&](const fs::path& of) {
    const ResourceLimit no_more_files(RLIMIT_NOFILE, 0);
    FolderLock lock(of);
  };
  CHECK_THROWS_WITH(lock(folder.path()), folder.path().string() + ": cannot be opened: Too many open files");
  CHECK_THROWS_WITH(FolderLock(folder / "none"), Contains("none: cannot be opened: No such file"));
}

TEST_CASE("of commands that make one kept folder at once, one has it, and the others leave it alone") {
  const ScratchFolder folder;
  for (int round = 0; round < 20; ++round) {
    const auto run = [&](const std::function<void()>& wait) {
      const KeptFolder kept(folder / "w");
      wait();
      if (!fs::is_directory(folder / "w")) throw Error("gone");
    };
    CHECK(do_at_once(4, run) == 1);
    fs::remove(folder / "w");  // another one may have made it
  }
}

TEST_CASE("kept and temporary files are not put into results, which are replaced as a whole") {
  const ScratchFolder folder;
  fs::create_directories(folder / "holes/deeper");
  folder.write("holes/holes.json", "{}");
  folder.write("holes/.lacuna", "holes.json\n");
  const auto refuse = [&](const std::string& kept, const std::string& out) {
    require_outside_results(folder / kept, folder / out, "--workspace");
  };
  for (const std::string kept : {"holes", "holes/w", "holes/deeper/w"})
    CHECK_THROWS_WITH(refuse(kept, "other"),
                      Contains("is in the folder of results " + (folder / "holes").string() +
                               "; allowed: another one for --workspace"));
  CHECK_THROWS_WITH(refuse("out/w", "out"), Contains("is in the folder of results"));
  refuse("w", "out");
  refuse("w", "w/out");
  const TemporaryFolder left(folder.path(), ".holes.lacuna-");
  CHECK_THROWS_WITH(refuse(left.path().filename() / "w", "out"),
                    Contains("is in the temporary folder of a run"));
  CHECK_THROWS_WITH(OutFolder(left.path() / "out", "holes.json"), Contains("is in the temporary folder"));
}

TEST_CASE("folders made for a run go if they are empty, and a detour is not made") {
  const ScratchFolder folder;
  {
    const MadeFolder made(folder / "a/b/../c");
    CHECK(made.path() == folder / "a/c");
    CHECK(fs::is_directory(folder / "a/c"));
    CHECK_FALSE(fs::exists(folder / "a/b"));
  }
  CHECK(folder.names().empty());
  { const MadeFolder made(folder / "a/../b/."); }
  CHECK(folder.names().empty());
  {
    const MadeFolder made(folder / "a/../b");
    folder.write("b/result", "");
  }
  CHECK(folder.names() == Names{"b"});
  fs::create_directory(folder / "real");
  fs::create_directory_symlink(folder / "real", folder / "b/link");
  const MadeFolder beside(folder / "b/link/../beside");  // a link leads where it leads
  CHECK(fs::is_directory(folder / "beside"));
}

}  // namespace lacuna::test
