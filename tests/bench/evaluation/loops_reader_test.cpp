// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/loops_reader.hpp"

#include "tests/io/io_support.hpp"

#include <sstream>

#include <catch2/catch.hpp>

namespace lacuna::test {
using namespace evaluation;

namespace {

using Loops = std::vector<LoopIds>;

std::string loops_ply(const std::string& rows, std::size_t count) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty double scalar_id\n"
         "property int scalar_loop\n"
         "end_header\n" +
         rows;
}

std::string loops_error(const std::filesystem::path& file) {
  return error_of([&] { read_loops(file); });
}

}  // namespace

TEST_CASE("loops as text are a line each, without comments and blank lines", "[io]") {
  const ScratchFolder folder;
  CHECK(read_loops(folder.write("a.loops.txt",
                                "# one loop per line\n3 1 2\n\n  #4 5 6\n 18446744073709551615\t7 \r\n8")) ==
        Loops{{3, 1, 2}, {18446744073709551615u, 7}, {8}});
  CHECK(read_loops(folder.write("none.loops.txt", "# none\n")).empty());
  CHECK(read_loops(folder.write("empty.loops.txt", "")).empty());
}

TEST_CASE("the comment before a loop is its name, that of the file is none", "[io]") {
  const ScratchFolder folder;
  const auto named = [&](const std::string& text) {
    std::vector<std::string> names;
    for (const NamedLoopIds& loop : read_named_loops(folder.write("a.loops.txt", text)))
      names.push_back(loop.name);
    return names;
  };
  using Names = std::vector<std::string>;
  const std::string head = std::string(kLoopsTextMark) + "a.ply\n";
  CHECK(named(head + "1 2 3\n# window\n4 5\n6 7\n  #shadow  of\tsofa, door \r\n8 9\n") ==
        Names{"", "window", "", "shadow of sofa, door"});
  CHECK(named("# no\n\n# yes\n\n1 2\n#\n3\n# of none\n") == Names{"yes", ""});
  CHECK(named("# " + std::string(300, 'x') + "\n1\n#" + std::string(300, 'x') + "\n2\n") == Names{"", ""});
  CHECK(read_named_loops(folder.write("a.ply", loops_ply("0 0 0 5 0\n", 1))).at(0).name.empty());
}

TEST_CASE("a line that begins with #step is a step of density, and neither a loop nor a name", "[io]") {
  const ScratchFolder folder;
  std::ostringstream many;
  many << "#step";
  for (int id = 0; id < 1000; ++id) many << ' ' << id;
  const std::string file = folder.write(
      "a.txt", "# head\n1 2 3\n#step 4 5 4\n 7 8\n" + many.str() + "\n9\n#steps 1 2\n# step 3\n");
  CHECK(read_loops(file) == Loops{{1, 2, 3}, {7, 8}, {9}});
  for (const NamedLoopIds& loop : read_named_loops(file)) CHECK((loop.name.empty() || loop.name == "head"));
  const Loops steps = read_steps(file);
  REQUIRE(steps.size() == 2);
  CHECK(steps[0] == LoopIds{4, 5, 4});
  CHECK(steps[1].size() == 1000);
  CHECK(read_steps(folder.write("none.txt", "1 2 3\n")).empty());
  CHECK(read_steps(folder.write("a.ply", loops_ply("0 0 0 5 0\n", 1))).empty());
  CHECK_THAT(error_of([&] { read_steps(folder.write("b.txt", "1 2\n#step 3 x\n")); }),
             Catch::Matchers::Contains("line 2: 'x' is not a point id"));
}

TEST_CASE("loops as text that are no ids are reported with their line", "[io]") {
  const ScratchFolder folder;
  using Catch::Matchers::Contains;
  CHECK_THAT(loops_error(folder.write("a.txt", "# ids\n1 2 3\n4 5 -6\n")),
             Contains("a.txt: line 3: '-6' is not a point id"));
  CHECK_THAT(loops_error(folder.write("a.txt", "1 2 3 # a hole\n")), Contains("line 1: '#'"));
  CHECK_THAT(loops_error(folder.write("a.txt", std::string("\1\2\0\xff", 4))), Contains("line 1: '???"));
  CHECK_THAT(loops_error(folder / "missing.txt"), Contains("missing.txt: cannot be opened"));
  CHECK_THAT(loops_error(folder.path()), Contains("is a folder"));
}

TEST_CASE("loops.ply has its loops one after the other", "[io]") {
  const ScratchFolder folder;
  CHECK(read_loops(folder.write("a.ply", loops_ply("0 0 0 5 0\n0 0 0 5000000001 0\n0 0 0 2 1\n", 3))) ==
        Loops{{5, 5'000'000'001}, {2}});
  CHECK(read_loops(folder.write("a.ply", loops_ply("", 0))).empty());
  CHECK(read_ids(folder.write("a.ply", loops_ply("0 0 0 5 0\n0 0 0 3 0\n", 2))) ==
        std::vector<std::uint64_t>{5, 3});
}

TEST_CASE("a PLY without loops, or with broken ones, is reported with its place", "[io]") {
  const ScratchFolder folder;
  using Catch::Matchers::Contains;
  const std::string points =
      "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n";
  CHECK_THAT(loops_error(folder.write("a.ply", points)), Contains("no property 'scalar_id'"));
  CHECK_THAT(loops_error(folder.write("a.ply", loops_ply("0 0 0 1 0\n0 0 0 1 2\n", 2))),
             Contains("vertex 1 (from 0): loop 2 where 1 would be the next"));
  CHECK_THAT(loops_error(folder.write("a.ply", loops_ply("0 0 0 1.5 0\n", 1))),
             Contains("'scalar_id' is 1.5"));
  CHECK_THAT(loops_error(folder.write("a.ply", loops_ply("0 0 0 nan 0\n", 1))),
             Contains("'scalar_id' is nan"));
  CHECK_THAT(loops_error(folder.write("a.ply", loops_ply("0 0 0 1e17 0\n", 1))), Contains("whole number"));
  CHECK_THAT(loops_error(folder.write("a.ply", loops_ply("0 0 0 1 -1\n", 1))),
             Contains("'scalar_loop' is -1"));
}

}  // namespace lacuna::test
