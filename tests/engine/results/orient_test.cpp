// SPDX-License-Identifier: Apache-2.0
#include "engine/results/orient.hpp"

#include "tests/support/clouds.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

OrientedEnd end_at(std::uint64_t id, const Eigen::Vector3d& normal) {
  return {PointId{id}, Row{100 + id}, normal};
}

OrientationEdge edge(double weight, std::uint64_t low, std::uint64_t high) {
  return {weight, PointId{low}, PointId{high}, Row{low}, Row{high}, 0};
}

TEST_CASE("an edge says how far two normals are from parallel, and whether they are opposed") {
  const OrientationEdge same = orientation_edge(end_at(7, {0, 0, 1}), end_at(3, {0, 0, 1}));
  CHECK(same.weight == 0);
  CHECK(same.low_id == PointId{3});
  CHECK(same.low == Row{103});
  CHECK(same.high == Row{107});
  CHECK(same.opposed == 0);
  const OrientationEdge opposed = orientation_edge(end_at(1, {0, 0.6, 0.8}), end_at(2, {0, 0, -1}));
  CHECK(opposed.weight == Approx(0.2));
  CHECK(opposed.opposed == 1);
  CHECK(orientation_edge(end_at(1, {1, 0, 0}), end_at(2, {0, 1, 0})).weight == 1);
}

TEST_CASE("an edge is the same from both ends, to the last bit") {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const OrientedEnd a = end_at(1, random.direction()), b = end_at(2, random.direction());
    const OrientationEdge one = orientation_edge(a, b), other = orientation_edge(b, a);
    CHECK((one.weight == other.weight && one.opposed == other.opposed && one.low == other.low));
  }
}

TEST_CASE("the forest leaves out the heaviest edge of a ring, of equal ones the last by ids") {
  const auto ends = [](const std::vector<OrientationEdge>& edges) {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> pairs;
    for (const OrientationEdge& e : edges) pairs.emplace_back(value(e.low_id), value(e.high_id));
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  };
  using Pairs = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
  CHECK(ends(spanning_forest({edge(0.5, 0, 1), edge(0.9, 1, 2), edge(0.1, 0, 2)}, 0, 3)) ==
        Pairs{{0, 1}, {0, 2}});
  CHECK(ends(spanning_forest({edge(0.5, 1, 2), edge(0.5, 0, 2), edge(0.5, 0, 1)}, 0, 3)) ==
        Pairs{{0, 1}, {0, 2}});
  CHECK(spanning_forest({}, 0, 0).empty());
}

TEST_CASE("rows count from the tile's first") {
  CHECK(spanning_forest({edge(0.5, 640, 641), edge(0.6, 641, 642)}, 640, 3).size() == 2);
}

TEST_CASE("a forest of parts' forests and the edges between is the forest of the whole") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    std::vector<OrientationEdge> all, low, high, reduced;
    for (std::uint64_t a = 0; a < 60; ++a) {
      for (std::uint64_t b = a + 1; b < 60; ++b) {
        if (random.chance(0.1)) all.push_back(edge(double(random.whole(0, 5)) / 8, a, b));
      }
    }
    for (const OrientationEdge& e : all) {
      if (value(e.high_id) < 30)
        low.push_back(e);
      else if (value(e.low_id) >= 30)
        high.push_back(e);
      else
        reduced.push_back(e);
    }
    for (const OrientationEdge& e : spanning_forest(low, 0, 30)) reduced.push_back(e);
    for (const OrientationEdge& e : spanning_forest(high, 30, 30)) reduced.push_back(e);
    const auto keys = [](std::vector<OrientationEdge> edges) {
      std::sort(edges.begin(), edges.end());
      std::vector<std::tuple<double, PointId, PointId>> keys;
      for (const OrientationEdge& e : edges) keys.emplace_back(e.weight, e.low_id, e.high_id);
      return keys;
    };
    CHECK(keys(spanning_forest(reduced, 0, 60)) == keys(spanning_forest(all, 0, 60)));
  }
}

}  // namespace
}  // namespace lacuna
