// SPDX-License-Identifier: Apache-2.0
// What the files of lids say of holes that have none.
#include "io/results/lids.hpp"

#include "engine/run/parallel.hpp"
#include "io/lids/make_lid.hpp"
#include "tests/io/results/fake_detection.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna {
using namespace io;

namespace {

void add(test::FakeDetection& run, LoopKind kind, const std::vector<Eigen::Vector3d>& points) {
  Loop& loop = run.found.emplace_back();
  for (const Eigen::Vector3d& point : points) loop.push_back(test::loop_point(loop.size(), point));
  run.measures.push_back({.kind = kind, .points = points.size()});
}

fs::path write(const ScratchFolder& scratch, const Detection& run) {
  const fs::path obj = scratch / "lids.obj", csv = scratch / "lids.csv";
  OutputFile out("lids.obj", obj), table("lids.csv", csv);
  TaskArena(2).for_each(1, [&](std::size_t) { write_lids_obj(run, out); });
  out.close();
  write_lids_table(obj, table);
  table.close();
  return csv;
}

}  // namespace

TEST_CASE("lids.csv has a line for each hole, with the reason where it has no lid") {
  test::FakeDetection run;
  add(run, LoopKind::kHole, {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}});
  add(run, LoopKind::kOuter, {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}});
  add(run, LoopKind::kHole, {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}});
  add(run, LoopKind::kHole, {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}});
  add(run, LoopKind::kHole, {{0, 0, 5}, {1, 0, 5}, {0, 1, 5}});
  const ScratchFolder scratch;
  CHECK(test::read_file(write(scratch, run)) ==
        "loop,triangles,lid_area,reason\n"
        "0,2,2,\n"
        "2,0,,the loop crosses itself, and its lid does\n"
        "3,0,,all points in one line\n"
        "4,1,0.5,\n");
}

TEST_CASE("islands in a hole stay open in the files of lids") {
  test::FakeDetection run;
  add(run, LoopKind::kOuter, {{1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}});
  add(run, LoopKind::kHole, {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}});
  run.measures[0].parent = 1;
  const ScratchFolder scratch;
  CHECK(test::read_file(write(scratch, run)) == "loop,triangles,lid_area,reason\n1,8,8,\n");
}

TEST_CASE("a loop that is too long is not read") {
  test::FakeDetection run;
  add(run, LoopKind::kHole, {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}});
  run.measures[0].points = kMostLoopPoints + 1;
  Detection detection = run;
  detection.for_each_loop_point = [](std::size_t, const auto&) { FAIL("it was read"); };
  const ScratchFolder scratch;
  CHECK_THAT(test::read_file(write(scratch, detection)), EndsWith("0,0,,more than 5000 points\n"));
}

}  // namespace lacuna
