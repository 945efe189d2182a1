// SPDX-License-Identifier: Apache-2.0
// Files of the workspace that change or stay behind while a run goes on.
#include "tests/support/clouds.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/system.hpp"

namespace lacuna::test {
namespace {

// A scan and how to run it so that its lists do not fit in memory.
struct Run {
  ScratchFolder folder;
  fs::path out = folder / "out";
  std::vector<std::string> arguments;

  Run() {
    const std::string scan =
        folder.write("scan.txt", plane(420).punched({120, 120}, 10).jittered(0.2, 1).text());
    arguments = {"detect",        scan,  "--out",          out.string(), "--quiet",
                 "--tile-points", "300", "--memory-limit", "64MiB",      "--points"};
  }
};

TEST_CASE("a file of the workspace that is cut short during the run ends it with one line that names it") {
  // A column, lists of records and lists of bytes.
  for (const std::string file : {"points", "halo", "outputs"}) {
    INFO(file);
    const Run run;
    bool was_cut = false;
    const ProgramResult result =
        run_program_beside(run.arguments, [&](pid_t program) { was_cut |= cut_open_file(program, file); });
    CHECK(was_cut);
    check_failure(result, 1, "/" + file + ": the file was cut short");
    CHECK_FALSE(fs::exists(run.out));
  }
}

TEST_CASE("a killed run leaves no file but marks, and no folder of results") {
  const Run run;
  const ProgramResult result = run_program_beside(run.arguments, [](pid_t program) {
    if (has_open(program, "halo")) kill(program, SIGKILL);
  });
  REQUIRE(result.exit_code == 128 + SIGKILL);
  CHECK_FALSE(fs::exists(run.out));
  std::size_t folders = 0, files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(temporary_of(run.out)))
    ++(entry.is_directory() ? folders : files);
  CHECK(folders == 2);  // for results and for temporary files
  CHECK(files == 2);    // the marks of these
}

}  // namespace
}  // namespace lacuna::test
