// SPDX-License-Identifier: Apache-2.0
// Files of the workspace that change or stay behind while a run goes on.
#include "tests/support/clouds.hpp"
#include "tests/support/open_files.hpp"
#include "tests/support/run_program.hpp"

#include <csignal>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using test::ProgramResult;
using test::ScratchFolder;

std::string as_text(const Cloud& cloud) {
  std::ostringstream text;
  text << "x y z\n";
  for (const Eigen::Vector3d& p : cloud.positions) text << p.transpose() << '\n';
  return text.str();
}

// A scan and how to run it so that its lists do not fit in memory.
struct Run {
  ScratchFolder folder;
  fs::path out = folder / "out";
  std::vector<std::string> arguments;

  explicit Run(const std::string& method) {
    const std::string scan =
        folder.write("scan.txt", as_text(plane(420).punched({120, 120}, 10).jittered(0.2, 1)));
    arguments = {"detect",        scan,  "--out",          out.string(), "--method", method, "--quiet",
                 "--tile-points", "300", "--memory-limit", "64MiB",      "--points"};
  }
};

TEST_CASE("a file of the workspace that is cut short during the run ends it with one line that names it") {
  for (const auto& [method, file] :
       std::vector<std::pair<std::string, std::string>>{{"tangential", "points"},
                                                        {"tangential", "halo"},
                                                        {"tangential", "sites"},
                                                        {"tangential", "results"},
                                                        {"tangential", "outputs"}}) {
    INFO(file << ", --method " << method);
    const Run run(method);
    bool was_cut = false;
    const ProgramResult result = test::run_program_beside(
        run.arguments, [&, &file = file](pid_t program) { was_cut |= test::cut_open_file(program, file); });
    INFO(result.err);
    CHECK(was_cut);
    CHECK(result.exit_code == 1);
    CHECK_THAT(result.err,
               StartsWith("lacuna: error: ") && Contains("/" + file + ": the file was cut short"));
    CHECK(test::count_lines(result.err) == 1);
    CHECK_FALSE(fs::exists(run.out));
  }
}

TEST_CASE("a killed run leaves no file, and no folder of results") {
  const Run run("tangential");
  const ProgramResult result = test::run_program_beside(run.arguments, [](pid_t program) {
    if (test::has_open(program, "halo")) kill(program, SIGKILL);
  });
  REQUIRE(result.exit_code == 128 + SIGKILL);
  CHECK_FALSE(fs::exists(run.out));
  std::size_t folders = 0, files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(run.out.parent_path() / ".out.lacuna"))
    ++(entry.is_directory() ? folders : files);
  CHECK(folders == 2);  // for results and for temporary files
  CHECK(files == 0);
}

}  // namespace
}  // namespace lacuna
