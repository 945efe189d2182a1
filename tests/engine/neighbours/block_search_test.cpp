// SPDX-License-Identifier: Apache-2.0
// The search in blocks against looking at every point, in any order of the points.
#include "engine/neighbours/block_search.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/point_tree.hpp"
#include "tests/support/test.hpp"

namespace lacuna {
namespace {

struct Points {
  std::vector<Eigen::Vector3d> positions;
  std::vector<PointId> ids;
};

// Distinct finite points in the order of the cloud, or sorted by x first; ids shuffled.
Points points_of(const Cloud& cloud, bool sorted) {
  const auto before = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
  };
  std::map<Eigen::Vector3d, bool, decltype(before)> seen(before);
  Points points;
  for (const Eigen::Vector3d& p : cloud.positions) {
    if (p.allFinite() && seen.emplace(p.array() + 0.0, true).second)
      points.positions.push_back(p.array() + 0.0);
  }
  if (sorted) std::sort(points.positions.begin(), points.positions.end(), before);
  for (std::size_t i = 0; i < points.positions.size(); ++i)
    points.ids.push_back(PointId{(i * 7919 + 13) % 1'000'003});
  return points;
}

bool same(std::span<const LocalIndex> found, const std::vector<Neighbour>& expected) {
  return std::equal(found.begin(), found.end(), expected.begin(), expected.end(),
                    [](LocalIndex a, const Neighbour& b) { return a == b.index; });
}

void check_all(const Points& points, std::size_t k, LocalIndex first = 0) {
  BlockSearch search(points.positions, points.ids);
  std::size_t wrong = 0;
  const auto last = static_cast<LocalIndex>(points.positions.size());
  LocalIndex expected_query = first;
  search.nearest(first, last, k, [&](LocalIndex query, std::span<const LocalIndex> found) {
    CHECK(query == expected_query++);
    wrong += !same(found, nearest_plainly(points.positions, points.ids, query, k));
  });
  CHECK(expected_query == last);
  CHECK(wrong == 0);
}

void check_balls(BlockSearch& search, const PointTree& tree, LocalIndex first, LocalIndex last,
                 double radius) {
  std::vector<Neighbour> expected;
  std::size_t wrong = 0;
  search.within(first, last, radius, [&](LocalIndex query, std::span<const LocalIndex> found) {
    tree.within(query, radius * radius, expected);
    wrong += !same(found, expected);
  });
  CHECK(wrong == 0);
}

}  // namespace

TEST_CASE("the neighbours found in blocks are those of looking at every point") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Cloud cloud = random_cloud(7000 + seed);
    if (cloud.size() > 1500) continue;
    INFO("seed " << seed << ", " << cloud.size() << " points");
    check_all(points_of(cloud, seed % 2 == 0), 1 + seed % 20);
  }
}

TEST_CASE("exact ties on a lattice are decided by id, in blocks too") {
  for (const std::size_t k : {1, 6, 7, 15, 26}) check_all(points_of(lattice(7), true), k);
}

TEST_CASE("blocks that jump far, and more neighbours than are ranked by counting") {
  const Cloud clusters = sphere(200).joined(plane(12).translated({1e6, 0, 0})).shuffled(3);
  check_all(points_of(clusters, false), 15);
  check_all(points_of(scattered(700, 2), false), 250);
}

// Runs of queries that extend far beyond what they search for: single precision is no use for them.
TEST_CASE("blocks whose points lie in two places") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    const double apart = std::exp2(random.uniform(0, 8));
    Points points;
    for (int i = 0; i < 1900; ++i) {
      const double x = random.uniform(0, 30), y = random.uniform(0, 30);
      points.positions.push_back({i % 2 == 0 ? x : x + 30 * apart, y, 0.01 * random.uniform(0, 1)});
      points.ids.push_back(PointId{static_cast<std::uint64_t>(i)});
    }
    INFO("seed " << seed);
    check_all(points, 3 + seed);
  }
}

// The first query looks no farther than its last neighbour, and as many points are as far in true distances
// or rounded ones.
TEST_CASE("neighbours that end where the search does") {
  const Points points = points_of(plane(24).scaled(0.1).rotated({1, 2, 3}, 40), true);
  std::size_t wrong = 0;
  for (LocalIndex first = 0; first < points.positions.size(); first += 32) {
    for (std::size_t k = 1; k <= 24; ++k) {
      BlockSearch search(points.positions, points.ids);
      const LocalIndex last =
          std::min<LocalIndex>(first + 32, static_cast<LocalIndex>(points.positions.size()));
      search.nearest(first, last, k, [&](LocalIndex query, std::span<const LocalIndex> found) {
        if (query == first) wrong += !same(found, nearest_plainly(points.positions, points.ids, query, k));
      });
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("balls that end at a point hold it") {
  const Points points = points_of(plane(24).scaled(0.1).rotated({1, 2, 3}, 40), true);
  const auto last = static_cast<LocalIndex>(points.positions.size());
  const PointTree tree(points.positions, points.ids);
  BlockSearch search(points.positions, points.ids);
  for (const LocalIndex end : {1, 2, 30, 55, 77, 200}) {
    const double radius = std::sqrt(squared_distance(points.positions[0], points.positions[end]));
    check_balls(search, tree, 0, last, radius);
  }
}

TEST_CASE("queries may start anywhere, and fewer points than k are all neighbours") {
  check_all(points_of(plane(20).jittered(0.2, 1), true), 15, 133);
  for (const int n : {1, 2, 15, 16, 17, 33}) check_all(points_of(scattered(n, 4), false), 16);
}

TEST_CASE("the search in blocks agrees with a kd-tree on many points, within a radius too") {
  Random random(5);
  Cloud cloud;
  for (int i = 0; i < 60'000; ++i) {  // a density step, noise, and a few points far away
    const double spread = i % 100 == 0 ? 50 : 1;
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    cloud.positions.push_back({spread * (x < 0 ? 4 * x : x), spread * y, random.uniform(-0.002, 0.002)});
  }
  const Points points = points_of(cloud, true);
  const auto last = static_cast<LocalIndex>(points.positions.size());
  const PointTree tree(points.positions, points.ids);
  BlockSearch search(points.positions, points.ids);
  std::vector<Neighbour> expected;
  std::size_t wrong = 0;
  const auto check_nearest = [&](LocalIndex query, std::span<const LocalIndex> found) {
    tree.nearest(query, 15, expected);
    wrong += !same(found, expected);
  };
  search.nearest(0, last, 15, check_nearest);
  for (const double radius : {0.004, 0.03, 0.2}) check_balls(search, tree, 1000, 3000, radius);
  search.nearest(5, 9, 15, check_nearest);  // once more, after balls
  CHECK(wrong == 0);
}

}  // namespace lacuna
