// SPDX-License-Identifier: Apache-2.0
#include "engine/results/orientation.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna {
namespace {

OrientationEdge edge(double weight, std::uint64_t low, std::uint64_t high) {
  return {weight, PointId{low}, PointId{high}, Row{low}, Row{high}, 0};
}

TEST_CASE("a forest of parts' forests and the edges between is the forest of the whole") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    std::vector<OrientationEdge> all, low, high, reduced;
    for (std::uint64_t a = 0; a < 60; ++a) {
      for (std::uint64_t b = a + 1; b < 60; ++b)
        if (random.chance(0.1)) all.push_back(edge(double(random.whole(0, 5)) / 8, a, b));
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
