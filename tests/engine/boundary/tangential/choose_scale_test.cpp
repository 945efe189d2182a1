// Which loops stand, of drawn ones at both scales.
#include "engine/boundary/tangential/choose_scale.hpp"

#include "tests/support/scratch_folder.hpp"
#include "tests/support/tiled_scan.hpp"

#include <vector>

#include <catch2/catch.hpp>

namespace lacuna::tangential {
namespace {

struct DrawnLoop {
  std::vector<std::uint64_t> rows;
  double length;
  double confidence = 0.75;
};

// The lengths of the loops that stand, where each loop has another length.
std::vector<double> chosen(const std::vector<DrawnLoop>& fine, const std::vector<DrawnLoop>& coarse,
                           double same_hole = 0.8) {
  const test::ScratchFolder folder;
  Config config;
  config.tangential.same_hole = same_hole;
  NoProgress progress;
  const Job job(config, folder.path(), progress);
  const auto loops_of = [&](const std::vector<DrawnLoop>& drawn, const char* name) {
    RawLoops loops(folder.path() / name);
    for (const DrawnLoop& loop : drawn) {
      std::vector<Vertex> vertices;
      for (const std::uint64_t row : loop.rows) vertices.push_back({PointId{row + 1000}, Row{row}});
      loops.add(vertices, {.confidence = loop.confidence, .length = loop.length});
    }
    loops.sort();
    return loops;
  };
  const RawLoops of_fine = loops_of(fine, "fine"), of_coarse = loops_of(coarse, "coarse");
  RawLoops standing(folder.path() / "standing");
  choose_scale(of_fine, of_coarse, job, standing);
  standing.sort();
  std::vector<double> lengths;
  for (std::size_t i = 0; i < standing.size(); ++i) {
    lengths.push_back(standing.rating(i).length);
  }
  return lengths;
}

using Lengths = std::vector<double>;

TEST_CASE("a fine loop around the same hole as a coarse one stands, and the coarse one falls") {
  CHECK(chosen({{{1, 2, 3, 4, 5, 6}, 6}}, {{{1, 3, 5}, 5}}) == Lengths{6});
}

TEST_CASE("a loop at one scale only stands") {
  CHECK(chosen({{{1, 2, 3}, 3}}, {}) == Lengths{3});
  CHECK(chosen({}, {{{1, 2, 3}, 3}}) == Lengths{3});
  CHECK(chosen({{{1, 2, 3}, 3}}, {{{4, 5, 6}, 4}}) == Lengths{3, 4});
  CHECK(chosen({}, {}).empty());
}

TEST_CASE("a fine loop that is much longer than the coarse loops on it falls, and these stand") {
  const DrawnLoop winding{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, 20, 0.7};
  CHECK(chosen({winding}, {{{1, 2, 3}, 4}, {{6, 7, 8}, 5}}) == Lengths{4, 5});
  CHECK(chosen({winding}, {{{1, 2, 3}, 9}, {{6, 7, 8}, 7.5}}) == Lengths{20});  // 16.5 of 20
  CHECK(chosen({winding}, {{{1, 2, 3}, 4}}, 0.2) == Lengths{20});
}

TEST_CASE("a fine loop stands where no coarse loop on it is surer") {
  const DrawnLoop winding{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, 20, 0.8};
  CHECK(chosen({winding}, {{{1, 2, 3}, 4, 0.7}, {{6, 7, 8}, 5, 0.8}}) == Lengths{20});
  CHECK(chosen({winding}, {{{1, 2, 3}, 4, 0.7}, {{6, 7, 8}, 5, 0.9}}) == Lengths{4, 5});
}

TEST_CASE("a coarse loop lies on the fine one with which it shares most points, the first of several") {
  const DrawnLoop first{{1, 2, 3, 4, 5}, 10, 0.5}, second{{6, 7, 8, 9, 11}, 30, 0.5};
  CHECK(chosen({first, second}, {{{4, 5, 6, 7, 8}, 9}}) == Lengths{10, 9});  // on the second, which falls
  CHECK(chosen({first, second}, {{{3, 4, 5, 6, 7}, 9}}) == Lengths{10, 30});
  CHECK(chosen({first, second}, {{{4, 5, 6, 7}, 7}}) == Lengths{7, 30});  // two of each: on the first
}

}  // namespace
}  // namespace lacuna::tangential
