// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/hole_width.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/grid_places.hpp"

namespace lacuna::evaluation {
namespace {

// The points of a grid, a unit apart, around a square.
LoopIds around(const std::vector<Eigen::Vector3d>& grid, int low, int edge) {
  LoopIds ids;
  for (const auto& [x, y] : test::places_around(low, low, edge, edge))
    ids.push_back(std::uint64_t(std::ranges::find(grid, Eigen::Vector3d(x, y, 0)) - grid.begin()));
  return ids;
}

}  // namespace

TEST_CASE("the width of a square hole is half its edge over the local spacing, an outer curve has none") {
  // A vertex has neighbours at 1, 1, 1 and sqrt(2); at a corner all four are at 1.
  std::vector<Eigen::Vector3d> grid = plane(20).positions;
  std::erase_if(grid, [](const Eigen::Vector3d& p) {
    return p.head<2>().minCoeff() > 4 && p.head<2>().maxCoeff() < 10;
  });
  const PointTree tree(grid);
  const std::vector<LoopIds> loops = {around(grid, 4, 6), around(grid, 0, 19)};
  std::vector<std::uint64_t> own(grid.size());
  std::iota(own.begin(), own.end(), std::uint64_t{0});
  const std::vector<TrueLoop> truth = loops_through(loops, own);
  const double spacing = (20 * (3 + std::sqrt(2)) / 4 + 4) / 24;
  CHECK(*hole_width(truth[0], grid, grid, tree) == Approx(3 / spacing));
  CHECK_FALSE(hole_width(truth[1], grid, grid, tree));
}

TEST_CASE("a hole counts in the class that begins at its width, found or not") {
  const TrueMatch found{.found_by = 0}, missed, uncounted{.counts = false};
  const std::vector<std::optional<double>> widths = {1.9, 2.0, 2.9, 10.0, 80.0, std::nullopt, 4.0};
  const std::vector<TrueMatch> matches = {missed, found, missed, found, found, found, uncounted};
  const HolesByWidth holes = holes_by_width(widths, matches);
  const std::array<std::array<std::size_t, 2>, 5> expected = {{{0, 1}, {1, 2}, {0, 0}, {0, 0}, {2, 2}}};
  for (std::size_t i = 0; i < holes.size(); ++i)
    CHECK(std::array{holes[i].found, holes[i].all} == expected[i]);
}

}  // namespace lacuna::evaluation
