// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/loops.hpp"

#include "tests/support/scratch_folder.hpp"

#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

using Ids = std::vector<std::uint64_t>;

TEST_CASE("loops are sorted by first id, then length, then ids, then scale") {
  const test::ScratchFolder folder;
  Loops loops(folder / "loops");
  const auto add = [&](const Ids& ids, bool is_coarse) {
    loops.add(ids.size(), {.is_coarse = is_coarse}, [&](std::uint64_t i) {
      return LoopPoint{{double(ids[i]), 0, 0, PointId{ids[i]}}, {0, 0, 0}, 0.5f};
    });
  };
  for (const Ids& ids : {Ids{5, 6, 9}, Ids{2, 7, 8, 9}, Ids{2, 6, 9}, Ids{5, 6, 8}, Ids{2, 4, 5}})
    add(ids, true);
  add({2, 6, 9}, false);
  CHECK(loops.points() == 19);
  loops.sort();
  std::vector<Ids> sorted;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    sorted.emplace_back();
    loops.for_each_point(i, [&](const LoopPoint& p) {
      sorted.back().push_back(value(p.id));
      CHECK(p.x == double(value(p.id)));
    });
  }
  CHECK(sorted == std::vector<Ids>{{2, 4, 5}, {2, 6, 9}, {2, 6, 9}, {2, 7, 8, 9}, {5, 6, 8}, {5, 6, 9}});
  CHECK_FALSE(loops.evidence(1).is_coarse);
  CHECK(loops.evidence(2).is_coarse);
  CHECK(loops.count(3) == 4);
  CHECK(compare_points(loops, 1, loops, 2) == 0);
  CHECK(compare_points(loops, 0, loops, 1) < 0);
  CHECK(compare_points(loops, 5, loops, 4) > 0);
}

}  // namespace
}  // namespace lacuna
