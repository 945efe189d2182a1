// Which loops stand, of drawn ones at both scales.
#include "engine/boundary/tangential/choose_scale.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/tiled_scan.hpp"

#include <algorithm>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna::tangential {
namespace {

struct DrawnLoop {
  std::vector<std::uint64_t> rows;
  double length;
  double confidence = 0.8;
};

// The lengths of the loops that stand, where each loop has another length.
std::vector<double> chosen(const std::vector<DrawnLoop>& fine, const std::vector<DrawnLoop>& coarse,
                           double same_hole = 0.8, double min_confidence = 0) {
  const test::ScratchFolder folder;
  Config config;
  config.tangential.same_hole = same_hole;
  config.selection.min_confidence = min_confidence;
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

TEST_CASE("a fine loop that is much longer than the surer coarse loops on it falls, and these stand") {
  const DrawnLoop winding{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, 20, 0.77};
  CHECK(chosen({winding}, {{{1, 2, 3}, 4}, {{6, 7, 8}, 5}}) == Lengths{4, 5});
  CHECK(chosen({winding}, {{{1, 2, 3}, 9}, {{6, 7, 8}, 7.5}}) == Lengths{20});  // 16.5 of 20
  CHECK(chosen({winding}, {{{1, 2, 3}, 4}}, 0.2) == Lengths{20});
}

TEST_CASE("a fine loop stands where no coarse loop on it is surer") {
  const DrawnLoop winding{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, 20, 0.8};
  CHECK(chosen({winding}, {{{1, 2, 3}, 4, 0.7}, {{6, 7, 8}, 5, 0.8}}) == Lengths{20});
  CHECK(chosen({winding}, {{{1, 2, 3}, 4, 0.7}, {{6, 7, 8}, 5, 0.9}}) == Lengths{4, 5});
}

TEST_CASE("of two loops for the same place of which one is not sure, the surer stands") {
  const DrawnLoop fine{{1, 2, 3, 4, 5, 6}, 6, 0.3}, coarse{{1, 3, 5}, 5, 0.99};
  CHECK(chosen({fine}, {coarse}) == Lengths{5});
  CHECK(chosen({coarse}, {fine}) == Lengths{5});
}

TEST_CASE("coarse loops that are not sure add no length to the loops that a sure fine one is compared with") {
  const DrawnLoop winding{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, 20, 0.8};
  CHECK(chosen({winding}, {{{1, 2, 3}, 4, 0.9}, {{6, 7, 8}, 15, 0.7}}) == Lengths{4, 15});
  CHECK(chosen({winding}, {{{1, 2, 3}, 4, 0.9}, {{6, 7, 8}, 15, 0.75}}) == Lengths{20});
}

TEST_CASE("a coarse loop lies on each fine one that has at least a quarter of its points") {
  const DrawnLoop first{{1, 2, 3, 4, 5}, 10, 0.5}, second{{6, 7, 8, 9, 11}, 30, 0.5};
  CHECK(chosen({first, second}, {{{4, 5, 6, 7, 8}, 9}}) == Lengths{9});
  CHECK(chosen({first, second}, {{{1, 2, 3, 4, 6}, 9}}) == Lengths{9, 30});  // a fifth on the second
  CHECK(chosen({first, second}, {{{2, 3, 4, 6}, 7}}) == Lengths{7});
}

TEST_CASE(
    "the loops at a higher confidence are a subset of those at a lower one, of drawn loops and of scans") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    std::vector<DrawnLoop> drawn[2];
    double length = 1;  // another one for each loop
    for (auto& of_scale : drawn) {
      for (std::int64_t loops = random.whole(0, 8); loops > 0; --loops) {
        DrawnLoop loop{{}, length, random.uniform(0, 1)};
        for (std::uint64_t row = 1; row <= 30; ++row) {
          if (random.uniform(0, 1) < 0.3) loop.rows.push_back(row);
        }
        if (loop.rows.empty()) continue;
        length *= 1.1;
        of_scale.push_back(loop);
      }
    }
    Lengths before = chosen(drawn[0], drawn[1]);
    std::sort(before.begin(), before.end());
    for (const double least : {0.2, 0.5, 0.75, 0.8, 0.95}) {
      INFO("seed " << seed << ", " << least);
      Lengths now = chosen(drawn[0], drawn[1], 0.8, least);
      std::sort(now.begin(), now.end());
      CHECK(std::includes(before.begin(), before.end(), now.begin(), now.end()));
      before = now;
    }
  }
}

TEST_CASE("a higher --min-confidence leaves loops out, and changes none") {
  std::size_t left_out = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Cloud cloud = random_cloud(4'000 + seed);
    std::vector<std::vector<PointId>> before;
    for (const double least : {0.0, 0.3, 0.75, 0.95}) {
      INFO("seed " << seed << ", " << least);
      Config config;
      config.selection.min_confidence = least;
      const std::vector<std::vector<PointId>> now = run_engine(cloud, config).loop_ids();
      if (least > 0) {
        CHECK(std::includes(before.begin(), before.end(), now.begin(), now.end()));
        left_out += before.size() - now.size();
      }
      before = now;
    }
  }
  CHECK(left_out > 100);
}

}  // namespace
}  // namespace lacuna::tangential
