// SPDX-License-Identifier: Apache-2.0
// lacuna update: a run whose input has changed in places.
#include "tests/support/run_program.hpp"
#include "tests/support/sheet.hpp"

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::check_failure;
using test::ProgramResult;
using test::run_program;
using test::ScratchFolder;

struct Updated {
  ScratchFolder folder;
  std::string first = folder.write("first.txt", test::sheet(120));
  std::string patch = folder.write("patch.txt", filling());
  std::string workspace = (folder / "workspace").string(), out = (folder / "out").string();

  // What lacks in the hole of the sheet.
  static std::string filling() {
    std::string text = "x y z\n";
    for (int i = 44; i <= 76; ++i) {
      for (int j = 44; j <= 76; ++j) text += std::to_string(i + 0.2) + " " + std::to_string(j + 0.3) + " 0\n";
    }
    return text;
  }
  ProgramResult run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--quiet", "--points", "--tile-points", "600"});
    return run_program(arguments);
  }
  explicit Updated(std::vector<std::string> options = {}) {
    options.insert(options.begin(), {"detect", first, "--workspace", workspace, "--out", out});
    REQUIRE(run(options).exit_code == 0);
  }

  std::vector<std::string> update(std::vector<std::string> more) const {
    more.insert(more.begin(), {"update", workspace});
    return more;
  }
  void is_as(std::vector<std::string> from_nothing) const {
    const fs::path other = folder / "nothing";
    from_nothing.insert(from_nothing.begin(), "detect");
    from_nothing.insert(from_nothing.end(), {"--out", other.string()});
    const ProgramResult result = run(from_nothing);
    INFO(result.err);
    REQUIRE(result.exit_code == 0);
    test::check_same_results(out, other);
  }
  std::map<std::string, int> changes() const {
    std::map<std::string, int> counts;
    const nlohmann::json json = test::read_json(folder / "out" / "changes.json");
    for (const auto& change : json.at("changes")) ++counts[change.at("change")];
    return counts;
  }
};

TEST_CASE("update adds files, leaves out boxes, and says which holes are closed and new") {
  const Updated scan;
  const ProgramResult added = run_program(scan.update({"--add", scan.patch}));
  INFO(added.err);
  REQUIRE(added.exit_code == 0);
  CHECK_THAT(added.out, Contains("changes: 1 closed, 0 new, 0 changed, 1 same"));
  CHECK(scan.changes() == std::map<std::string, int>{{"closed", 1}, {"same", 1}});
  scan.is_as({scan.first, scan.patch});

  REQUIRE(scan.run(scan.update({"--leave-out", "20,20,-1,30,30,1", "--leave-out", "80,80,-1,90,95,1"}))
              .exit_code == 0);
  CHECK(scan.changes() == std::map<std::string, int>{{"new", 2}, {"same", 1}});
  scan.is_as({scan.first, scan.patch, "--leave-out", "20,20,-1,30,30,1,80,80,-1,90,95,1"});

  // Boxes add up.
  REQUIRE(scan.run(scan.update({"--leave-out", "50,50,-1,60,60,1"})).exit_code == 0);
  CHECK(scan.changes().at("new") == 1);
  scan.is_as({scan.first, scan.patch, "--leave-out", "20,20,-1,30,30,1,80,80,-1,90,95,1,50,50,-1,60,60,1"});
  CHECK_FALSE(fs::exists(fs::path(scan.workspace) / "before"));

  // The results of another run in the folder have no changes.
  REQUIRE(scan.run({"detect", scan.first, "--out", scan.out}).exit_code == 0);
  CHECK_FALSE(fs::exists(scan.folder / "out" / "changes.json"));
}

TEST_CASE("update replaces a file in its place") {
  const Updated scan;
  REQUIRE(scan.run(scan.update({"--add", scan.patch})).exit_code == 0);
  const std::string moved = scan.folder.write("moved.txt", test::sheet(118));
  REQUIRE(scan.run(scan.update({"--replace", scan.first + "=" + moved})).exit_code == 0);
  scan.is_as({moved, scan.patch});
}

TEST_CASE("the sample of an update with fewer points is that of a run from nothing") {
  const Updated scan({"--sample-points", "300"});
  const std::string half = "-1,-1,-1,60,130,1";
  REQUIRE(scan.run(scan.update({"--leave-out", half})).exit_code == 0);
  scan.is_as({scan.first, "--sample-points", "300", "--leave-out", half});
}

TEST_CASE("an update that is killed goes on with the same command") {
  const Updated scan;
  const std::vector<std::string> arguments = scan.update({"--add", scan.patch, "--quiet"});
  for (const char* name : {"before", "run", "level-0-0", "level-1-0"}) {
    test::run_program_until(arguments, SIGKILL, [&] { return fs::exists(fs::path(scan.workspace) / name); });
  }
  REQUIRE(run_program(arguments).exit_code == 0);
  scan.is_as({scan.first, scan.patch});
}

TEST_CASE("an update that was stopped knows what it compares with, also once the results are gone") {
  const Updated scan;
  const std::vector<std::string> arguments = scan.update({"--add", scan.patch, "--quiet"});
  const fs::path kept = fs::path(scan.workspace) / "before" / "run";
  test::run_program_until(arguments, SIGKILL, [&] { return fs::exists(kept); });
  if (!fs::exists(kept)) return;  // it was done before
  fs::remove_all(scan.out);
  REQUIRE(run_program(arguments).exit_code == 0);
  CHECK(scan.changes() == std::map<std::string, int>{{"closed", 1}, {"same", 1}});
  CHECK_FALSE(fs::exists(fs::path(scan.workspace) / "before"));
}

TEST_CASE("what cannot be updated is said in a line") {
  const Updated scan;
  check_failure(run_program(scan.update({"--replace", scan.first})), 2, "--replace: allowed: OLD=NEW");
  check_failure(run_program(scan.update({"--replace", scan.patch + "=missing.txt"})), 1,
                "is no input of the run");
  check_failure(run_program(scan.update({"--leave-out", "1,2,3"})), 2, "6 for each box");
  check_failure(run_program(scan.update({"--leave-out", "1,2,3,0,5,6"})), 2,
                "min x = 1.0 is above max x = 0.0");
  check_failure(run_program(scan.update({"--add", "missing.txt"})), 1, "missing.txt");
  check_failure(run_program({"update", scan.folder.path().string(), "--out", scan.out}), 1,
                "not the workspace of a run");
  fs::rename(fs::path(scan.workspace) / "results", scan.folder / "results");
  check_failure(run_program(scan.update({"--add", scan.patch})), 1,
                "does not name the folder of its results");
  fs::rename(scan.folder / "results", fs::path(scan.workspace) / "results");
}

TEST_CASE("an update that was made does nothing again, and keeps what has changed") {
  const Updated scan;
  const std::string box = "20,20,-1,30,30,1";
  for (const std::vector<std::string>& change :
       {std::vector<std::string>{"--add", scan.patch}, {"--leave-out", box}}) {
    REQUIRE(scan.run(scan.update(change)).exit_code == 0);
    const std::string changes = test::read_file(fs::path(scan.out) / "changes.json");
    const auto again = run_program(scan.update(change));
    CHECK(again.exit_code == 0);
    CHECK_THAT(again.out, Catch::Matchers::Contains("nothing is left to do"));
    CHECK(test::read_file(fs::path(scan.out) / "changes.json") == changes);
  }
  scan.is_as({scan.first, scan.patch, "--leave-out", box});
  fs::remove(fs::path(scan.out) / "holes.json");  // then the results are made again
  REQUIRE(run_program(scan.update({"--add", scan.patch})).exit_code == 0);
  scan.is_as({scan.first, scan.patch, "--leave-out", box});
}

TEST_CASE("an update that is refused leaves the workspace as it was") {
  const Updated scan;
  check_failure(run_program(scan.update({"--add", "missing.txt"})), 1, "missing.txt");
  CHECK_FALSE(fs::exists(fs::path(scan.workspace) / "before"));
  REQUIRE(scan.run({"detect", scan.first, "--workspace", scan.workspace, "--out", scan.out}).exit_code == 0);
}

}  // namespace
}  // namespace lacuna
