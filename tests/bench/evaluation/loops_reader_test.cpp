// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/loops_reader.hpp"

#include "tests/io/io_support.hpp"

namespace lacuna::test {
using namespace evaluation;

namespace {

using Loops = std::vector<LoopIds>;

// An id and a loop a line, each at 0 0 0.
std::string loops_ply(const std::string& rows) {
  return ascii_ply(rows, kXyz + "property double scalar_id\nproperty int scalar_loop\n");
}

// A file of loops of this name and each content is refused.
void check_loops_refused(const std::string& name, const std::vector<Wrong>& cases) {
  const ScratchFolder folder;
  check_reasons(cases, [&](const std::string& content) {
    return error_of([&] { read_loops(folder.write(name, content)); });
  });
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
  CHECK(read_named_loops(folder.write("a.ply", loops_ply("0 0 0 5 0\n"))).at(0).name.empty());
}

TEST_CASE("a line that begins with a mark is neither a loop nor a name", "[io]") {
  const ScratchFolder folder;
  std::ostringstream many;
  many << "#step";
  for (int id = 0; id < 1000; ++id) many << ' ' << id;
  const std::string file = folder.write("a.txt", "# head\n1 2 3\n#step 4 5 4\n 7 8\n" + many.str() +
                                                     "\n9\n#steps 1 2\n# step 3\n#narrow 6 7 8\n");
  CHECK(read_loops(file) == Loops{{1, 2, 3}, {7, 8}, {9}});
  for (const NamedLoopIds& loop : read_named_loops(file)) CHECK((loop.name.empty() || loop.name == "head"));
  const Loops steps = read_marked(file, kStepMark);
  REQUIRE(steps.size() == 2);
  CHECK(steps[0] == LoopIds{4, 5, 4});
  CHECK(steps[1].size() == 1000);
  CHECK(read_marked(file, kNarrowMark) == Loops{{6, 7, 8}});
  CHECK(read_marked(folder.write("none.txt", "1 2 3\n"), kStepMark).empty());
  CHECK(read_marked(folder.write("a.ply", loops_ply("0 0 0 5 0\n")), kStepMark).empty());
  CHECK_THAT(error_of([&] { read_marked(folder.write("b.txt", "1 2\n#step 3 x\n"), kStepMark); }),
             Contains("line 2: 'x' is not a point id"));
}

TEST_CASE("loops as text that are no ids are reported with their line", "[io]") {
  const ScratchFolder folder;
  check_loops_refused("a.txt", {{"# ids\n1 2 3\n4 5 -6\n", "a.txt: line 3: '-6' is not a point id"},
                                {"1 2 3 # a hole\n", "line 1: '#'"},
                                {std::string("\1\2\0\xff", 4), "line 1: '???"}});
  CHECK_THAT(error_of([&] { read_loops(folder / "missing.txt"); }), Contains("cannot be opened"));
  CHECK_THAT(error_of([&] { read_loops(folder.path()); }), Contains("is a folder"));
}

TEST_CASE("loops.ply has its loops one after the other", "[io]") {
  const ScratchFolder folder;
  const auto file = folder.write("a.ply", loops_ply("0 0 0 5 0\n0 0 0 5000000001 0\n0 0 0 2 1\n"));
  CHECK(read_loops(file) == Loops{{5, 5'000'000'001}, {2}});
  CHECK(read_ids(file) == std::vector<std::uint64_t>{5, 5'000'000'001, 2});
  CHECK(read_loops(folder.write("a.ply", loops_ply(""))).empty());
}

TEST_CASE("a PLY without loops, or with broken ones, is reported with its place", "[io]") {
  check_loops_refused("a.ply", {{ascii_ply(""), "no property 'scalar_id'"},
                                {loops_ply("0 0 0 1 0\n0 0 0 1 2\n"), "vertex 1 (from 0): loop 2 where 1"},
                                {loops_ply("0 0 0 1.5 0\n"), "'scalar_id' is 1.5"},
                                {loops_ply("0 0 0 nan 0\n"), "'scalar_id' is nan"},
                                {loops_ply("0 0 0 1e17 0\n"), "whole number"},
                                {loops_ply("0 0 0 1 -1\n"), "'scalar_loop' is -1"}});
}

}  // namespace lacuna::test
