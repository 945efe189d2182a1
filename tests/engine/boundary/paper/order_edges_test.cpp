// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/order_edges.hpp"

#include "engine/evaluate/evaluate.hpp"
#include "tests/support/clouds.hpp"

#include <algorithm>
#include <tuple>

#include <catch2/catch.hpp>

namespace lacuna::paper {
namespace {

using Key = std::tuple<double, PointId, PointId>;

std::vector<Key> keys(const std::vector<WeightedEdge>& edges, const std::vector<PointId>& ids) {
  std::vector<Key> keys;
  for (const auto& [a, b, weight] : edges)
    keys.emplace_back(weight, std::min(ids[a], ids[b]), std::max(ids[a], ids[b]));
  return keys;
}

TEST_CASE("edges come in ascending order of weight, then lower id, then higher id") {
  for (const std::int64_t most : {0, 3, 1000, 50'331'647}) {
    Random random(static_cast<std::uint64_t>(most) + 1);
    std::vector<PointId> ids;
    for (int v = 0; v < 100; ++v) ids.push_back(PointId{random.next()});
    std::vector<WeightedEdge> edges;
    for (int i = 0; i < 3000; ++i) {
      edges.push_back({static_cast<LocalIndex>(random.whole(0, 99)),
                       static_cast<LocalIndex>(random.whole(0, 99)),
                       static_cast<double>(random.whole(0, most)) * kProbabilityStep});
    }
    std::vector<Key> expected = keys(edges, ids);
    std::sort(expected.begin(), expected.end());
    order_edges(edges, ids);
    CHECK(keys(edges, ids) == expected);
  }
}

TEST_CASE("weights one step apart are distinguished up to the largest") {
  const std::vector<PointId> ids{PointId{0}, PointId{1}};
  std::vector<WeightedEdge> edges{{0, 1, 1e9}, {0, 1, 1e9 - kProbabilityStep}, {0, 1, 0}, {0, 1, 3}};
  order_edges(edges, ids);
  CHECK(edges[0].weight == 0);
  CHECK(edges[1].weight == 3);
  CHECK(edges[2].weight == 1e9 - kProbabilityStep);
  CHECK(edges[3].weight == 1e9);
}

TEST_CASE("no edges are in order") {
  std::vector<WeightedEdge> edges;
  order_edges(edges, {});
  CHECK(edges.empty());
}

}  // namespace
}  // namespace lacuna::paper
